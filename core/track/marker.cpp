#include "core/track/marker.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "core/track/marker_edges.h"

namespace ilf {

namespace {

using cv::aruco::Dictionary;

std::optional<int> dictionaryNumber(const std::string& name) {
    using namespace cv::aruco;
    static const std::map<std::string, int> known{
        {"4X4_50", DICT_4X4_50},
        {"4X4_100", DICT_4X4_100},
        {"4X4_250", DICT_4X4_250},
        {"4X4_1000", DICT_4X4_1000},
        {"5X5_50", DICT_5X5_50},
        {"5X5_100", DICT_5X5_100},
        {"5X5_250", DICT_5X5_250},
        {"5X5_1000", DICT_5X5_1000},
        {"6X6_50", DICT_6X6_50},
        {"6X6_100", DICT_6X6_100},
        {"6X6_250", DICT_6X6_250},
        {"6X6_1000", DICT_6X6_1000},
        {"7X7_50", DICT_7X7_50},
        {"7X7_100", DICT_7X7_100},
        {"7X7_250", DICT_7X7_250},
        {"7X7_1000", DICT_7X7_1000},
        {"ARUCO_ORIGINAL", DICT_ARUCO_ORIGINAL},
        {"APRILTAG_16h5", DICT_APRILTAG_16h5},
        {"APRILTAG_25h9", DICT_APRILTAG_25h9},
        {"APRILTAG_36h10", DICT_APRILTAG_36h10},
        {"APRILTAG_36h11", DICT_APRILTAG_36h11},
    };
    const auto at = known.find(name);
    return at == known.end() ? std::nullopt : std::optional(at->second);
}

Result<cv::Ptr<Dictionary>> dictionaryOf(const std::string& name) {
    const auto number = dictionaryNumber(name);
    if (!number) {
        return fail(Fault::unsupported, "There is no marker dictionary \"" + name +
                                            "\": use APRILTAG_36h11, 4X4_50, 5X5_100, 6X6_250 or another of OpenCV's.");
    }
    return cv::aruco::getPredefinedDictionary(*number);
}

Result<void> hasMarker(const Dictionary& dictionary, const std::string& name, int id) {
    if (id >= 0 && id < dictionary.bytesList.rows) return {};
    return fail(Fault::outOfRange, "The dictionary " + name + " has the markers 0 to " +
                                       std::to_string(dictionary.bytesList.rows - 1) + ", not " + std::to_string(id) +
                                       ".");
}

/// The wanted markers alone, in the order of `ids`: what is not asked for is neither compared with nor mistaken.
Result<cv::Ptr<Dictionary>> only(const std::string& name, const std::vector<int>& ids) {
    const auto whole = dictionaryOf(name);
    if (!whole) return whole;
    auto some = cv::makePtr<Dictionary>();
    some->markerSize = (*whole)->markerSize;
    some->maxCorrectionBits = (*whole)->maxCorrectionBits;
    for (const int id : ids) {
        if (auto has = hasMarker(**whole, name, id); !has) return tl::unexpected(has.error());
        some->bytesList.push_back((*whole)->bytesList.row(id));
    }
    return some;
}

cv::Ptr<cv::aruco::DetectorParameters> parameters(Size size, int around) {
    auto p = cv::aruco::DetectorParameters::create();
    p->adaptiveThreshWinSizeMin = around > 0 ? around : 5;
    p->adaptiveThreshWinSizeMax = around > 0 ? around : 21;
    p->adaptiveThreshWinSizeStep = 8;
    // Of the longer side, but a marker is at least 12 px wide, below which its bits cannot be read.
    p->minMarkerPerimeterRate = std::min(0.5, 48.0 / std::max(size.width, size.height));
    p->maxMarkerPerimeterRate = 8.0;
    // Less than the white rim, whose outer edge would else be taken for the marker's where paper ends.
    p->minMarkerDistanceRate = 0.015;
    p->minDistanceToBorder = 1;
    p->polygonalApproxAccuracyRate = 0.05;
    p->cornerRefinementMethod = cv::aruco::CORNER_REFINE_NONE;
    return p;
}

/// A quad whose edge points are this many pixels off their lines is no straight-edged thing any more.
constexpr double kRough_px = 0.6;
/// Grey values across the outline that make an edge beyond doubt.
constexpr double kSureContrast = 40.0;

double confidenceOf(const Outlined& outline) {
    const double straight = std::exp(-(outline.rms_px * outline.rms_px) / (kRough_px * kRough_px));
    return outline.found * straight * std::min(1.0, outline.contrast / kSureContrast);
}

/// One marker is found once for the outside and once for the inside of its outline: the surer one stands.
void add(std::vector<SeenMarker>& seen, SeenMarker marker) {
    for (SeenMarker& other : seen) {
        const auto a = middleOf(other.corners), b = middleOf(marker.corners);
        const double side = std::sqrt(std::abs(signedArea(other.corners)));
        if (other.id != marker.id || std::hypot(a.x - b.x, a.y - b.y) > 0.5 * side) continue;
        if (marker.confidence > other.confidence) other = std::move(marker);
        return;
    }
    seen.push_back(std::move(marker));
}

}  // namespace

Result<void> checkedMarker(const std::string& dictionary, int id) {
    const auto whole = dictionaryOf(dictionary);
    if (!whole) return tl::unexpected(whole.error());
    return hasMarker(**whole, dictionary, id);
}

MarkerSearch partOfSearch(MarkerSearch whole, Size picture, int look) {
    // As many pixels take as long at full size as a picture of 1280 x 720 does at half; overlapping by a marker that
    // is found at half size.
    constexpr int kPixels = 320'000, kOverlap = 64;
    const int turn = look / 2;
    const int strips = std::max(1, (picture.width * picture.height + kPixels - 1) / kPixels);
    whole.coarse = look % 2 == 0 ? 2 : 1;
    const int round = whole.coarse == 2 ? turn : turn / strips;
    whole.around = round % 2 == 0 ? 5 : 21;
    if (whole.coarse == 1) {
        const int strip = turn % strips;
        whole.window = {0, picture.height * strip / strips - kOverlap / 2, picture.width,
                        picture.height * (strip + 1) / strips + kOverlap / 2};
        whole.window = whole.window.clipped(picture);
    }
    return whole;
}

Result<std::vector<SeenMarker>> findMarkers(const Image<std::uint8_t>& grey, const MarkerSearch& search) {
    std::vector<SeenMarker> seen;
    try {
        const auto dictionary = only(search.dictionary, search.ids);
        if (!dictionary) return tl::unexpected(dictionary.error());
        if (grey.empty() || search.ids.empty()) return seen;
        const PixelRect<CameraFrame> whole{0, 0, grey.width(), grey.height()};
        const auto window = search.window.empty() ? whole : search.window.clipped(grey.size());
        if (window.width() < 16 || window.height() < 16) return seen;

        // OpenCV reads the pixels only, but has no view of constant ones.
        cv::Mat picture(grey.height(), grey.width(), CV_8UC1, const_cast<std::uint8_t*>(grey.pixels().data()));
        cv::Mat part = picture(cv::Rect(window.x0, window.y0, window.width(), window.height()));
        const int coarse = std::max(1, search.coarse);
        if (coarse > 1) {
            cv::Mat small;
            cv::resize(part, small, {part.cols / coarse, part.rows / coarse}, 0, 0, cv::INTER_AREA);
            part = small;
        }
        std::vector<std::vector<cv::Point2f>> corners;
        std::vector<int> ids;
        cv::aruco::detectMarkers(part, *dictionary, corners, ids, parameters({part.cols, part.rows}, search.around));
        const double sx = static_cast<double>(window.width()) / part.cols;
        const double sy = static_cast<double>(window.height()) / part.rows;
        for (std::size_t i = 0; i < ids.size(); ++i) {
            Quad rough;
            for (std::size_t k = 0; k < 4; ++k)
                rough[k] = {window.x0 + sx * (static_cast<double>(corners[i][k].x) + 0.5),
                            window.y0 + sy * (static_cast<double>(corners[i][k].y) + 0.5)};
            const Outlined outline = outlined(grey, rough, (*dictionary)->markerSize + 2);
            add(seen,
                {search.ids[static_cast<std::size_t>(ids[i])], outline.corners, confidenceOf(outline), outline.rms_px});
        }
    } catch (const cv::Exception& e) {
        return fail(Fault::unsupported, std::string("Markers could not be looked for: ") + e.what());
    }
    return seen;
}

}  // namespace ilf
