#include "projects/pinhole_json.h"

namespace ilf::projects {

Json written(const Pinhole& pinhole, const std::string& unit, Json json) {
    json.set(("width" + unit).c_str(), pinhole.size.width);
    json.set(("height" + unit).c_str(), pinhole.size.height);
    json.set(("fx" + unit).c_str(), pinhole.fx);
    json.set(("fy" + unit).c_str(), pinhole.fy);
    json.set(("cx" + unit).c_str(), pinhole.cx);
    json.set(("cy" + unit).c_str(), pinhole.cy);
    json.set("distortion", std::vector<double>(pinhole.distortion.begin(), pinhole.distortion.end()));
    return json;
}

Pinhole pinholeFrom(JsonReader reader, const std::string& unit) {
    Pinhole pinhole;
    pinhole.size = {reader.whole(("width" + unit).c_str()), reader.whole(("height" + unit).c_str())};
    pinhole.fx = reader.number(("fx" + unit).c_str());
    pinhole.fy = reader.number(("fy" + unit).c_str());
    pinhole.cx = reader.number(("cx" + unit).c_str());
    pinhole.cy = reader.number(("cy" + unit).c_str());
    std::ranges::copy(reader.numbers("distortion", pinhole.distortion.size()), pinhole.distortion.begin());
    return pinhole;
}

}  // namespace ilf::projects
