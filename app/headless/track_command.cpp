#include "app/headless/track_command.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <vector>

#include "app/exit_code.h"
#include "app/headless/prepare.h"
#include "app/headless/track_frames.h"
#include "core/base/as_text.h"
#include "core/base/grey.h"
#include "core/document/edit.h"
#include "core/track/marker.h"
#include "core/track/region_tracker.h"
#include "devices/camera/camera.h"

namespace ilf::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr Second kPeriod = Second::fromSi(1.0 / 60.0);

/// One picture's answer for one region.
struct Line {
    Second time;
    FollowedNow now;
    Motion motion;
    std::optional<double> error_px, ahead_px;  ///< against the truth: at the exposure, and where its light falls
};

Result<MarkerTarget> markerFrom(const std::string& text) {
    const auto colon = text.find(':');
    MarkerTarget marker;
    if (colon != std::string::npos) marker.dictionary = text.substr(0, colon);
    char rest = 0;
    const std::string number = colon == std::string::npos ? text : text.substr(colon + 1);
    if (std::sscanf(number.c_str(), "%7d%c", &marker.id, &rest) != 1)
        return fail(Fault::outOfRange, "--marker " + text + " is no marker: write its number, or 6X6_250:7.");
    if (const auto ok = checkedMarker(marker.dictionary, marker.id); !ok) return tl::unexpected(ok.error());
    return marker;
}

Result<PlanarTarget> patchFrom(const std::string& text) {
    PixelRect<CameraFrame> p;
    char rest = 0;
    if (std::sscanf(text.c_str(), "%7d,%7d,%7d,%7d%c", &p.x0, &p.y0, &p.x1, &p.y1, &rest) != 4)
        return fail(Fault::outOfRange, "--patch " + text + " is no rectangle: write its corners as X0,Y0,X1,Y1.");
    return PlanarTarget{p};
}

/// What is followed: the project's regions, or one in the first picture.
Result<Document> followed(const TrackOptions& options, const devices::Frame& first) {
    if (!options.project.empty()) {
        auto opened = openAny(options.project);
        if (!opened) return tl::unexpected(opened.error());
        const auto seen = [](const Box<Region>& region) {
            return region->follow && !std::holds_alternative<StreamTarget>(region->follow->target);
        };
        if (!std::ranges::any_of(opened->document.regions, seen))
            return fail(Fault::notFound, "No region of \"" + options.project +
                                             "\" follows a marker or a flat thing: set that in its Follows row.");
        return std::move(opened->document);
    }
    Follow follow;
    follow.hold = Second::fromSi(options.hold_ms / 1e3);
    follow.fade = Second::fromSi(options.fade_ms / 1e3);
    follow.whenLost = options.whenLost == "blur"    ? Follow::WhenLost::blur
                      : options.whenLost == "focus" ? Follow::WhenLost::focus
                                                    : Follow::WhenLost::neutral;
    if (!options.marker.empty()) {
        const auto marker = markerFrom(options.marker);
        if (!marker) return tl::unexpected(marker.error());
        follow.target = *marker;
    } else if (!options.patch.empty()) {
        const auto patch = patchFrom(options.patch);
        if (!patch) return tl::unexpected(patch.error());
        follow.target = *patch;
    } else {
        return fail(Fault::outOfRange, "Nothing is to be followed: name --project, --marker or --patch.");
    }
    Scene scene;
    scene.picture = Box(devices::asPicture(first));
    if (const auto ok = checked(follow, scene.size()); !ok) return tl::unexpected(ok.error());
    Document document = newDocument(std::move(scene));
    Region region;
    region.id = "region";
    region.name = options.marker.empty() ? "patch" : "marker " + options.marker;
    region.mask = Mask(document.scene.size());
    region.follow = follow;
    document.regions.push_back(Box(std::move(region)));
    return document;
}

std::string nameOf(const Document& document, const RegionId& id) {
    const Region* region = findRegion(document, id);
    return region != nullptr ? region->name : id;
}

/// Names may have commas.
std::string quoted(std::string text) {
    for (std::size_t at = 0; (at = text.find('"', at)) != std::string::npos; at += 2)
        text.insert(at, 1, '"');
    return '"' + text + '"';
}

void printCsvHead(bool truth) {
    std::cout << "time_s,region,state,confidence,fade,x_px,y_px,h00,h01,h02,h10,h11,h12,h20,h21,h22"
              << (truth ? ",error_px,error_of_light_px" : "") << '\n';
}

void printCsv(const Document& document, const Line& line) {
    const auto middle = middleOf(line.now.to);
    std::cout << asText("%.4f", line.time.si()) << ',' << quoted(nameOf(document, line.now.region)) << ','
              << word(line.now.state) << asText(",%.3f", line.now.confidence) << asText(",%.3f", line.now.fade)
              << asText(",%.3f", middle.x) << asText(",%.3f", middle.y);
    for (const double h : line.motion.m)
        std::cout << asText(",%.9g", h);
    if (line.error_px) std::cout << asText(",%.4f", *line.error_px) << asText(",%.4f", line.ahead_px.value_or(0.0));
    std::cout << '\n';
}

Json asJson(const Document& document, const Line& line) {
    const auto middle = middleOf(line.now.to);
    Json said{{"time_s", line.time.si()},      {"region", nameOf(document, line.now.region)},
              {"state", word(line.now.state)}, {"confidence", line.now.confidence},
              {"fade", line.now.fade},         {"middle_px", {middle.x, middle.y}},
              {"motion", line.motion.m}};
    if (line.error_px) said["error_px"] = *line.error_px;
    if (line.ahead_px) said["error_of_light_px"] = *line.ahead_px;
    return said;
}

struct Sum {
    double squares = 0.0, worst = 0.0;
    int count = 0;
    void add(double v) {
        squares += v * v;
        worst = std::max(worst, v);
        ++count;
    }
    Json json() const {
        return {{"rms_px", count > 0 ? std::sqrt(squares / count) : 0.0}, {"worst_px", worst}, {"count", count}};
    }
};

/// The farthest corner of the marker at `at`; regions were learnt in the picture of 0 s.
double offTruth(const TrackFrames& frames, const Motion& motion, Second at) {
    return farthestCorner(moved(frames.truth(0.0_s), motion), frames.truth(at));
}

Result<void> tracked(const TrackOptions& options) {
    const auto frames = trackFrames(options);
    if (!frames) return tl::unexpected(frames.error());
    auto frame = frames->next();
    if (!frame) return tl::unexpected(frame.error());
    if (!*frame) return fail(Fault::notFound, "There is no picture in \"" + options.source + "\".");
    const auto document = followed(options, **frame);
    if (!document) return tl::unexpected(document.error());

    LightTiming timing;
    timing.ahead = Second::fromSi(options.ahead_ms / 1e3);
    RegionTracker tracker;
    tracker.follow(*document, {true, false});
    for (const FollowedNow& now : tracker.now()) {
        if (!now.trouble.empty()) return fail(Fault::notFound, now.trouble);
    }
    const bool truth = frames->truth && options.project.empty() && !options.marker.empty();
    if (!options.json) printCsvHead(truth);
    Json lines = Json::array();
    Sum seen, lit;
    int following = 0, all = 0;
    for (; frame && *frame; frame = frames->next()) {
        // Pictures are dated by the middle of their exposure.
        const Second exposed = (*frame)->time, arrived = exposed + timing.readout + 0.5 * timing.exposure;
        tracker.see(greyOf((*frame)->rgb), exposed, arrived);
        RegionTracker then = tracker;
        const auto atExposure = then.moves(exposed, kPeriod);
        const Second sweep = arrived + timing.ahead, light = 0.5 * kPeriod;
        const auto moves = tracker.moves(sweep, kPeriod);
        const auto now = tracker.now();
        for (std::size_t i = 0; i < moves.size(); ++i) {
            Line line{exposed, now[i], motionAt(moves[i], light).motion, {}, {}};
            if (truth) {
                line.error_px = offTruth(*frames, motionAt(atExposure[i], 0.0_s).motion, exposed);
                line.ahead_px = offTruth(*frames, line.motion, sweep + light);
            }
            ++all;
            if (line.now.state == FollowState::following) {
                ++following;
                if (line.error_px) seen.add(*line.error_px);
                if (line.ahead_px) lit.add(*line.ahead_px);
            }
            if (options.json) {
                lines.push_back(asJson(*document, line));
            } else {
                printCsv(*document, line);
            }
        }
    }
    if (!frame) return tl::unexpected(frame.error());
    if (options.json) {
        Json said{{"source", options.source}, {"lines", std::move(lines)}, {"following", following}, {"of", all}};
        if (truth) said["error"] = seen.json(), said["error_of_light"] = lit.json();
        std::cout << said.dump(2) << '\n';
    }
    return {};
}

}  // namespace

int trackCommand(const TrackOptions& options) {
    const auto done = tracked(options);
    return done ? kDone : refused("track", done.error());
}

}  // namespace ilf::app
