#include "ui/units.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <span>

namespace ilf::ui {

namespace {

struct Suffix {
    std::string_view text;
    double toSi = 1.0;
    bool reciprocal = false;  ///< the value is one over what was typed: dioptres for a distance, metres for a power
};

constexpr auto lengths = std::to_array<Suffix>({{"m", 1.0},
                                                {"cm", 1e-2},
                                                {"mm", 1e-3},
                                                {"um", 1e-6},
                                                {"\u00b5m", 1e-6},
                                                {"\u03bcm", 1e-6},
                                                {"km", 1e3},
                                                {"dpt", 1.0, true},
                                                {"D", 1.0, true}});
constexpr auto powers = std::to_array<Suffix>(
    {{"D", 1.0}, {"dpt", 1.0}, {"dptr", 1.0}, {"m", 1.0, true}, {"cm", 1e-2, true}, {"mm", 1e-3, true}});
constexpr auto angles =
    std::to_array<Suffix>({{"deg", 1.0}, {"\u00b0", 1.0}, {"degrees", 1.0}, {"rad", 180.0 / std::numbers::pi}});
constexpr auto rates = std::to_array<Suffix>({{"Hz", 1.0}, {"hz", 1.0}, {"kHz", 1e3}});
constexpr auto times = std::to_array<Suffix>({{"ms", 1e-3}, {"s", 1.0}, {"us", 1e-6}, {"\u00b5s", 1e-6}});
constexpr auto years = std::to_array<Suffix>({{"years", 1.0}, {"y", 1.0}, {"a", 1.0}, {"year", 1.0}});
constexpr auto pixels = std::to_array<Suffix>({{"px", 1.0}, {"pixels", 1.0}});
constexpr auto shares = std::to_array<Suffix>({{"%", 1e-2}});

struct Kind {
    std::span<const Suffix> suffixes;
    double bare = 1.0;  ///< what a number without a unit is multiplied by
    const char* example = "";
};

Kind kind(Unit unit) {
    switch (unit) {
    case Unit::metre:
        return {lengths, 1.0, "0.5, 50 cm, 500 mm or 2 dpt"};
    case Unit::millimetre:
        return {lengths, 1e-3, "4, 4 mm or 0.4 cm"};
    case Unit::dioptre:
        return {powers, 1.0, "2, 2 D or 0.5 m"};
    case Unit::degree:
        return {angles, 1.0, "60, 60 deg or 1.05 rad"};
    case Unit::hertz:
        return {rates, 1.0, "60, 60 Hz or 0.96 kHz"};
    case Unit::millisecond:
        return {times, 1e-3, "0.46, 0.46 ms or 460 us"};
    case Unit::year:
        return {years, 1.0, "28 or 28 years"};
    case Unit::pixel:
        return {pixels, 1.0, "40 or 40 px"};
    case Unit::percent:
        return {shares, 1e-2, "80 or 80 %"};
    case Unit::number:
        break;
    }
    return {{}, 1.0, "1.4"};
}

std::string_view trimmed(std::string_view text) {
    const auto first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Units below one are powers of ten: dividing by the whole number keeps 70 cm at 0.7 and not 0.7000000000000001.
double scaled(double value, double toSi) { return toSi < 1.0 ? value / std::round(1.0 / toSi) : value * toSi; }

std::string decimals(double value, int digits, const char* suffix) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%.*f%s", digits, value == 0.0 ? 0.0 : value, suffix);
    return text.data();
}

}  // namespace

Result<double> parsed(std::string_view text, Unit unit) {
    const Kind accepted = kind(unit);
    const std::string shown(trimmed(text));
    const auto refuse = [&](const std::string& why) {
        return fail(Fault::outOfRange, why + " Type a number such as " + accepted.example + ".");
    };
    std::string number = shown;
    if (number.empty()) return refuse("Nothing was typed.");
    // Decimal comma, as half the world writes it; two of them are not a number.
    if (const auto comma = number.find(','); comma != std::string::npos && number.find('.') == std::string::npos) {
        number[comma] = '.';
    }
    if (number.front() == '+') number.erase(0, 1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), value);
    if (error != std::errc() || !std::isfinite(value)) return refuse("\"" + shown + "\" is not a number.");

    const std::string_view suffix =
        trimmed(std::string_view(end, static_cast<std::size_t>(number.data() + number.size() - end)));
    if (suffix.empty()) return scaled(value, accepted.bare);
    for (const Suffix& known : accepted.suffixes) {
        if (known.text != suffix) continue;
        if (!known.reciprocal) return scaled(value, known.toSi);
        if (value <= 0.0) return refuse("\"" + shown + "\" has no finite positive reciprocal.");
        return 1.0 / scaled(value, known.toSi);
    }
    return refuse("\"" + std::string(suffix) + "\" is not a unit of this field.");
}

Result<double> parsedWithin(std::string_view text, Unit unit, double low, double high) {
    return parsed(text, unit).and_then([&](double value) -> Result<double> {
        if (value >= low && value <= high) return value;
        return fail(Fault::outOfRange, "\"" + std::string(trimmed(text)) + "\" is outside what this field takes: " +
                                           formatted(low, unit) + " to " + formatted(high, unit) + ".");
    });
}

std::string formatted(double si, Unit unit) {
    const double size = std::abs(si);
    if (std::isinf(si)) return si > 0 ? "\u221e" : "-\u221e";
    switch (unit) {
    case Unit::metre:
        if (size >= 9.9995) return decimals(si, 1, " m");
        if (size >= 0.09995) return decimals(si, 3, " m");
        if (size == 0.0) return "0 m";
        if (size >= 1e-3) return decimals(si * 1e3, 1, " mm");
        return decimals(si * 1e6, 1, " \u00b5m");
    case Unit::millimetre:
        if (size != 0.0 && size < 1e-3) return decimals(si * 1e6, 1, " \u00b5m");
        return decimals(si * 1e3, size < 0.1 ? 2 : 1, " mm");
    case Unit::dioptre:
        return decimals(si, 2, " D");
    case Unit::degree:
        return decimals(si, 1, "\u00b0");
    case Unit::hertz:
        return decimals(si, std::abs(size - std::round(size)) < 0.05 ? 0 : 1, " Hz");
    case Unit::millisecond:
        return decimals(si * 1e3, 2, " ms");
    case Unit::year:
        return decimals(si, 0, " years");
    case Unit::pixel:
        return decimals(si, size < 9.95 ? 1 : 0, " px");
    case Unit::percent:
        return decimals(si * 1e2, 0, " %");
    case Unit::number:
        return decimals(si, std::abs(size - std::round(size)) < 0.005 ? 0 : 2, "");  // what is counted is whole
    }
    return {};
}

}  // namespace ilf::ui
