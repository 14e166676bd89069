#include "app/words.h"

#include <charconv>
#include <chrono>
#include <ctime>

namespace ilf::app {

std::optional<double> wholeNumber(std::string_view text) {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
}

std::string utcNow() {
    const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
    std::tm parts{};
    gmtime_r(&now, &parts);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
    return text;
}

Result<Look> lookFromWord(std::string_view text) {
    if (text == "focus") return Look::focus;
    if (text == "blur") return Look::blur;
    if (text == "neutral") return Look::neutral;
    return fail(Fault::outOfRange, "\"" + std::string(text) + "\" is no look: use focus, blur or neutral.");
}

Result<CircleOfConfusion> confusionFromWord(const std::string& text) {
    using Preset = CircleOfConfusion::Preset;
    if (text == "1arcmin") return CircleOfConfusion{Preset::oneArcmin, {}};
    if (text == "dof") return CircleOfConfusion{Preset::depthOfField, {}};
    if (text == "landolt") return CircleOfConfusion{Preset::landolt, {}};
    const auto metres = wholeNumber(text);
    if (!metres || !(*metres > 0.0 && *metres < 1e-3)) {
        return fail(Fault::outOfRange, "--coc \"" + text +
                                           "\" is no circle of confusion: use 1arcmin, dof, landolt, or a diameter on "
                                           "the retina in metres, such as 5e-6.");
    }
    return CircleOfConfusion{Preset::typed, Metre::fromSi(*metres)};
}

}  // namespace ilf::app
