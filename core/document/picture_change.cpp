#include "core/document/picture_change.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/registration/convert.h"

namespace ilf {

namespace {

using Change = Homography<CameraFrame, CameraFrame>;

bool known(Size size) { return size.width > 0 && size.height > 0; }

std::string sized(Size size) { return std::to_string(size.width) + " x " + std::to_string(size.height); }

/// What a scene says of its own picture.
CameraMode ownMode(const Scene& scene) {
    return known(scene.camera.picture) && scene.camera.picture == scene.size() ? scene.camera : CameraMode{};
}

/// Something whose place in the picture means something.
bool anythingLaid(const Document& document) {
    const auto laid = [](const Region& region) {
        return (!region.mask.empty() && !region.mask.blank()) || region.outline ||
               std::holds_alternative<PlaneDistance>(region.distance) ||
               (region.follow && std::holds_alternative<PlanarTarget>(region.follow->target));
    };
    return (document.background && laid(*document.background)) ||
           std::ranges::any_of(document.regions, [&](const Box<Region>& region) { return laid(*region); });
}

/// The change of a camera's mode between both pictures, if there is one and it can be told.
std::optional<Change> modeChange(const Document& document, const Scene& next) {
    const CameraMode before = pictureMode(document), now = ownMode(next);
    if (!known(before.picture) || !known(now.picture)) return std::nullopt;
    const auto change = oldFromNew(before, now);
    return change ? std::optional(*change) : std::nullopt;
}

/// Old pixels along one axis that make a new one, and how much of each.
struct Taps {
    int first = 0;
    std::vector<float> weights;  ///< less than 1 together where the new pixel reaches beyond the old picture
};

/// `old = scale * new + shift` along an axis of `from` old pixels and `to` new ones.
std::vector<Taps> tapsOf(double scale, double shift, int from, int to) {
    std::vector<Taps> all(static_cast<std::size_t>(to));
    for (int i = 0; i < to; ++i) {
        Taps& taps = all[static_cast<std::size_t>(i)];
        const auto add = [&](int at, double weight) {
            if (weight < 1e-9) return;
            if (taps.weights.empty()) taps.first = at;
            taps.weights.resize(static_cast<std::size_t>(at - taps.first) + 1, 0.0F);
            taps.weights.back() += static_cast<float>(weight);
        };
        const double low = scale * i + shift, high = low + scale;
        if (scale >= 1.0) {
            for (int k = std::max(0, static_cast<int>(std::floor(low))); k < from && k < high; ++k)
                add(k, (std::min(high, k + 1.0) - std::max(low, k + 0.0)) / scale);
            continue;
        }
        const double middle = 0.5 * (low + high);
        if (middle <= 0.0 || middle >= from) continue;
        const double at = std::clamp(middle - 0.5, 0.0, from - 1.0);
        const int k = std::min(static_cast<int>(at), from - 1);
        add(k, 1.0 - (at - k));
        if (k + 1 < from) add(k + 1, at - k);
    }
    return all;
}

struct Sampling {
    std::vector<Taps> columns, rows;

    Sampling(const Change& oldFromNew, Size from, Size to)
        : columns(tapsOf(oldFromNew.m[0], oldFromNew.m[2], from.width, to.width)),
          rows(tapsOf(oldFromNew.m[4], oldFromNew.m[5], from.height, to.height)) {}
};

std::size_t area(Size size) { return static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height); }

bool anyDepth(const Image<float>& metres) {
    return std::ranges::any_of(metres.pixels(), [](float m) { return m > 0.0F; });
}

/// Depth and scale where the mode changed by `change`.
void carry(const Scene& from, const Change& change, Scene& to) {
    const Size picture = to.size();
    const auto along = [&](Image<float>& metres, Image<float>& sigma) {
        if (!sigma.empty()) sigma = resampled(sigma, metres, change, picture);
        metres = resampled(metres, metres, change, picture);
        return anyDepth(metres);
    };
    if (from.measured) {
        MeasuredDepth measured = *from.measured;
        measured.camera = convertedBy(measured.camera, change, picture);
        if (along(measured.metres, measured.sigma)) to.measured = Box(std::move(measured));
    } else if (from.depth) {
        DepthMap depth = *from.depth;
        if (along(depth.metres, depth.sigma)) to.depth = Box(std::move(depth));
    }
    if (to.scale.source == PixelScale::Source::assumed)
        to.scale = {from.scale.focalPixels / change.m[0], from.scale.source};
}

}  // namespace

CameraMode pictureMode(const Document& document) {
    const Scene& scene = document.scene;
    if (const CameraMode own = ownMode(scene); known(own.picture)) return own;
    const Box<Registration>& made = document.rig.registration;
    const bool same = made && !made->camera.device.empty() && made->camera.device == scene.source &&
                      known(made->camera.picture) && made->camera.picture == scene.size();
    return same ? made->camera : CameraMode{};
}

Result<Change> oldFromNew(const Document& document, const Scene& next) {
    const CameraMode before = pictureMode(document), now = ownMode(next);
    const Size from = document.scene.size(), to = next.size();
    std::string why;
    if (known(before.picture) && known(now.picture)) {
        auto change = oldFromNew(before, now);
        if (change) return change;
        why = change.error().what;
    }
    if (from == to) return Change{};
    if (known(now.picture) && anythingLaid(document)) {
        if (why.empty()) {
            why = "the old picture (\"" + document.scene.source + "\") has " + sized(from) +
                  " pixels, and where the camera's " + sized(to) + " lie in it is not known.";
        }
        return fail(Fault::unsupported, "The regions cannot go along to this picture: " + why +
                                            " Choose the old camera and size, or begin a new project for this one.");
    }
    if (!known(from)) return Change{};
    return Change{{static_cast<double>(from.width) / to.width, 0.0, 0.0,  //
                   0.0, static_cast<double>(from.height) / to.height, 0.0, 0.0, 0.0, 1.0}};
}

Scene carriedOver(const Document& document, Scene next) {
    const Scene& now = document.scene;
    next.viewer = now.viewer;
    const auto change = modeChange(document, next);
    if (change && (*change != Change{} || now.size() != next.size())) {
        carry(now, *change, next);
    } else if (now.size() == next.size()) {
        next.depth = now.depth;
        next.measured = now.measured;
        if (now.scale.source != PixelScale::Source::assumed && next.scale.source == PixelScale::Source::assumed)
            next.scale = now.scale;
    }
    return next;
}

Mask resampled(const Mask& mask, const Change& oldFromNew, Size picture) {
    if (mask.empty() || mask.blank()) return Mask(picture);
    const Image<std::uint8_t> from = toImage(mask);
    const Sampling sampling(oldFromNew, from.size(), picture);
    std::vector<std::uint8_t> pixels;
    pixels.reserve(area(picture));
    std::vector<float> row(static_cast<std::size_t>(from.width()));
    for (const Taps& down : sampling.rows) {
        std::ranges::fill(row, 0.0F);
        for (std::size_t k = 0; k < down.weights.size(); ++k) {
            const std::uint8_t* source = from.row(down.first + static_cast<int>(k));
            for (std::size_t x = 0; x < row.size(); ++x)
                row[x] += down.weights[k] * static_cast<float>(source[x]);
        }
        for (const Taps& across : sampling.columns) {
            float sum = 0.0F;
            for (std::size_t k = 0; k < across.weights.size(); ++k)
                sum += across.weights[k] * row[static_cast<std::size_t>(across.first) + k];
            pixels.push_back(static_cast<std::uint8_t>(std::min(255.0F, sum + 0.5F)));
        }
    }
    return toTiles({picture, 1, std::move(pixels)});
}

Image<float> resampled(const Image<float>& metres, const Image<float>& surface, const Change& oldFromNew,
                       Size picture) {
    constexpr float kOneSurface = 0.02F;
    const Size size = metres.size();
    const Sampling sampling(oldFromNew, size, picture);
    std::vector<float> pixels;
    pixels.reserve(area(picture));
    const auto inside = [](double v, int length) { return std::clamp(static_cast<int>(std::floor(v)), 0, length - 1); };
    for (int y = 0; y < picture.height; ++y) {
        const Taps& down = sampling.rows[static_cast<std::size_t>(y)];
        for (int x = 0; x < picture.width; ++x) {
            const Taps& across = sampling.columns[static_cast<std::size_t>(x)];
            const auto middle = oldFromNew(Point<CameraFrame>{x + 0.5, y + 0.5});
            const bool seen = middle.x >= 0.0 && middle.y >= 0.0 && middle.x < size.width && middle.y < size.height;
            const float here = seen ? surface.at(inside(middle.x, size.width), inside(middle.y, size.height)) : 0.0F;
            float sum = 0.0F, weight = 0.0F;
            for (std::size_t j = 0; here > 0.0F && j < down.weights.size(); ++j) {
                for (std::size_t i = 0; i < across.weights.size(); ++i) {
                    const int u = across.first + static_cast<int>(i), v = down.first + static_cast<int>(j);
                    if (std::abs(surface.at(u, v) - here) > kOneSurface * here) continue;
                    const float by = across.weights[i] * down.weights[j];
                    sum += by * metres.at(u, v);
                    weight += by;
                }
            }
            pixels.push_back(weight > 0.0F ? sum / weight : 0.0F);
        }
    }
    return {picture, 1, std::move(pixels)};
}

}  // namespace ilf
