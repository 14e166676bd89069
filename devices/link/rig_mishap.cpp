#include "devices/link/rig_mishap.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <vector>

namespace ilf::devices {

Result<RigMishap> mishapFrom(const std::string& text) {
    std::vector<std::string> parts;
    for (std::size_t from = 0; from <= text.size();) {
        const auto colon = std::min(text.find(':', from), text.size());
        parts.push_back(text.substr(from, colon - from));
        from = colon + 1;
    }
    const auto help = "\"" + text + "\" is no mishap: write DEVICE:KIND[:AFTER[:TIMES[:AMOUNT]]], such as " +
                      "projector:unplug or lenses:clock-drift:0:0:200.";
    if (parts.size() < 2 || parts.size() > 5 || parts[0].empty() || parts[1].empty())
        return fail(Fault::outOfRange, help);
    parts.resize(5, "0");
    const auto number = [&](std::size_t part) -> std::optional<double> {
        double value = 0.0;
        const char* last = parts[part].data() + parts[part].size();
        const auto [end, error] = std::from_chars(parts[part].data(), last, value);
        if (error != std::errc() || end != last) return std::nullopt;
        return value;
    };
    const auto after = number(2), times = number(3), amount = number(4);
    if (!after || !times || !amount || !(*after >= 0.0 && *after < 1e15) || !(*times >= 0.0 && *times < 1e15))
        return fail(Fault::outOfRange, help);
    return RigMishap{parts[0], parts[1], static_cast<std::uint64_t>(*after), static_cast<std::uint64_t>(*times),
                     *amount};
}

}  // namespace ilf::devices
