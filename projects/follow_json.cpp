#include "projects/follow_json.h"

#include <string>
#include <vector>

namespace ilf::projects {

namespace {

const std::vector<std::string> kTargets{"marker", "planar", "stream"};
const std::vector<std::string> kWhenLost{"blur", "neutral", "focus"};

void set(Json& json, const MarkerTarget& marker) {
    json.set("dictionary", marker.dictionary);
    json.set("id", marker.id);
}
void set(Json& json, const PlanarTarget& target) {
    const auto& p = target.patch;
    json.set("patch_px", std::vector<double>{static_cast<double>(p.x0), static_cast<double>(p.y0),
                                             static_cast<double>(p.x1), static_cast<double>(p.y1)});
}
void set(Json& json, const StreamTarget& stream) { json.set("address", stream.address); }

}  // namespace

Json written(const Follow& follow, Json json) {
    // A key that stays keeps its place in the file; those of another target go.
    if (!std::holds_alternative<MarkerTarget>(follow.target)) {
        json.erase("dictionary");
        json.erase("id");
    }
    if (!std::holds_alternative<PlanarTarget>(follow.target)) json.erase("patch_px");
    if (!std::holds_alternative<StreamTarget>(follow.target)) json.erase("address");
    json.set("target", kTargets[follow.target.index()]);
    std::visit([&](const auto& target) { set(json, target); }, follow.target);
    json.set("when_lost", kWhenLost[static_cast<std::size_t>(follow.whenLost)]);
    json.set("hold_s", follow.hold.si());
    json.set("fade_s", follow.fade.si());
    return json;
}

Follow followFrom(JsonReader reader) {
    Follow follow;
    switch (reader.choice("target", kTargets)) {
    case 0:
        follow.target = MarkerTarget{reader.word("dictionary"), reader.whole("id")};
        break;
    case 1: {
        const std::vector<double> p = reader.numbers("patch_px", 4);
        const auto whole = [&](std::size_t i) { return i < p.size() ? static_cast<int>(p[i]) : 0; };
        follow.target = PlanarTarget{{whole(0), whole(1), whole(2), whole(3)}};
        break;
    }
    default:
        follow.target = StreamTarget{reader.word("address")};
    }
    follow.whenLost = static_cast<Follow::WhenLost>(reader.choice("when_lost", kWhenLost));
    follow.hold = Second::fromSi(reader.number("hold_s", follow.hold.si()));
    follow.fade = Second::fromSi(reader.number("fade_s", follow.fade.si()));
    return follow;
}

}  // namespace ilf::projects
