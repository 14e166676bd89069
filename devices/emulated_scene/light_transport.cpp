#include "devices/emulated_scene/light_transport.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"
#include "devices/emulated_scene/second_bounce.h"

namespace ilf::devices::scene {
namespace {

constexpr int kFine = 4;    // rays along a pixel's side where something ends inside it
constexpr int kCoarse = 3;  // looks along a pixel's side where nothing does
/// Luminance of red, green and blue (ITU-R BT.709).
constexpr std::array<float, 3> kLuminance{0.2126F, 0.7152F, 0.0722F};

struct Tap {
    std::uint32_t pixel;  ///< of the raster
    float weight;
};

/// Mean, over `span` around `t`, of what is +1 and -1 in turns for each whole number, +1 from 0 on.
float inTurns(float t, float span) {
    if (span < 1e-3F) return static_cast<int>(std::floor(t)) % 2 == 0 ? 1.0F : -1.0F;
    const auto integral = [](float to) { return 1.0F - std::abs(to - 2.0F * std::floor(0.5F * to) - 1.0F); };
    return (integral(t + 0.5F * span) - integral(t - 0.5F * span)) / span;
}

/// `spanU`, `spanV`: how much of the surface the look covers. A chessboard is averaged over it: were each look all dark
/// or all bright, edges would lie up to a sixth of a pixel off, and corners found on them 0.1 px.
std::array<float, 3> colourAt(const Look& look, float u, float v, float spanU, float spanV) {
    std::array<float, 3> colour = look.colour;
    if (look.squaresAcross > 0) {
        const auto across = static_cast<float>(look.squaresAcross), down = static_cast<float>(look.squaresDown);
        const float dark = 0.5F + 0.5F * inTurns(u * across, spanU * across) * inTurns(v * down, spanV * down);
        for (float& c : colour)
            c += dark * (look.dark - c);
    }
    if (!look.texture.empty()) {
        const int w = look.texture.width(), h = look.texture.height();
        const auto wrapped = [](float t, int n) {
            return std::min(n - 1, static_cast<int>((t - std::floor(t)) * static_cast<float>(n)));
        };
        const float* texel = look.texture.row(wrapped(v, h)) + 3 * wrapped(u, w);
        for (std::size_t c = 0; c < 3; ++c)
            colour[c] *= texel[c];
    }
    return colour;
}

float luminance(const std::array<float, 3>& colour) {
    return kLuminance[0] * colour[0] + kLuminance[1] * colour[1] + kLuminance[2] * colour[2];
}

Seen between(const Seen& a, const Seen& b, float t) {
    Seen s = a;
    const auto mix = [t](float p, float q) { return p + t * (q - p); };
    s.x = mix(a.x, b.x);
    s.y = mix(a.y, b.y);
    s.u = mix(a.u, b.u);
    s.v = mix(a.v, b.v);
    s.lux = mix(a.lux, b.lux);
    s.shine = mix(a.shine, b.shine);
    return s;
}

/// How much of [x - s / 2, x + s / 2] lies beyond the next whole number.
float beyond(float x, float s) { return std::clamp((x - std::floor(x) + 0.5F * s - 1.0F) / s, 0.0F, 1.0F); }
/// And how much before the one below.
float before(float x, float s) { return std::clamp((0.5F * s - (x - std::floor(x))) / s, 0.0F, 1.0F); }

/// Gathers the looks into one pixel: which projector pixels light it, how strongly, and its colour.
class Pixel {
public:
    explicit Pixel(Size raster) : raster_(raster) {}

    void clear() {
        taps_.clear();
        albedo_ = 0.0F;
        colour_ = {};
    }
    /// `spanX`, `spanY`: how much of the raster the look covers; `spanU`, `spanV`: of the surface; `share`: of the
    /// camera pixel.
    void look(const Seen& seen, const Look& look, float spanX, float spanY, float spanU, float spanV, float share) {
        if (seen.surface < 0) return;
        const auto colour = colourAt(look, seen.u, seen.v, spanU, spanV);
        const float grey = luminance(colour);
        albedo_ += share * grey;
        for (std::size_t c = 0; c < 3; ++c)
            colour_[c] += share * colour[c];
        if (!seen.lit) return;
        const float strength = share * (grey * seen.lux + look.gloss * seen.shine);
        spanX = std::clamp(spanX, 1e-3F, 1.0F);
        spanY = std::clamp(spanY, 1e-3F, 1.0F);
        const float right = beyond(seen.x, spanX), left = before(seen.x, spanX);
        const float below = beyond(seen.y, spanY), above = before(seen.y, spanY);
        const int x = static_cast<int>(std::floor(seen.x)), y = static_cast<int>(std::floor(seen.y));
        const float acrossShares[3] = {left, 1.0F - left - right, right};
        const float downShares[3] = {above, 1.0F - above - below, below};
        for (int j = -1; j <= 1; ++j) {
            for (int i = -1; i <= 1; ++i)
                add(x + i, y + j, strength * acrossShares[i + 1] * downShares[j + 1]);
        }
    }
    const std::vector<Tap>& taps() const { return taps_; }
    float albedo() const { return albedo_; }
    std::uint8_t tint(std::size_t channel) const {
        if (albedo_ <= 0.0F) return 64;
        return static_cast<std::uint8_t>(std::clamp(64.0F * colour_[channel] / albedo_ + 0.5F, 0.0F, 255.0F));
    }

private:
    void add(int x, int y, float weight) {
        if (!(weight > 0.0F) || x < 0 || y < 0 || x >= raster_.width || y >= raster_.height) return;
        const auto index = static_cast<std::uint32_t>(y * raster_.width + x);
        for (Tap& tap : taps_) {
            if (tap.pixel == index) {
                tap.weight += weight;
                return;
            }
        }
        taps_.push_back({index, weight});
    }

    Size raster_;
    std::vector<Tap> taps_;
    float albedo_ = 0.0F;
    std::array<float, 3> colour_{};
};

}  // namespace

struct LightTransport::Impl {
    SceneView view;
    std::vector<std::uint32_t> firstTap;  // of each camera pixel, and one past the last
    std::vector<Tap> taps;
    std::vector<float> albedo;
    std::vector<std::uint8_t> tint;
    SecondBounce bounce;

    Impl(Stage stage, const std::stop_token& stop) : view(std::move(stage)) { look(stop); }

    /// All four corners of a pixel see the same, evenly.
    static bool even(const Seen& a, const Seen& b, const Seen& c, const Seen& d) {
        const auto like = [&a](const Seen& s) {
            return s.surface == a.surface && s.lit == a.lit && std::abs(s.depth - a.depth) < 0.01F * a.depth &&
                   std::abs(s.x - a.x) < 8.0F && std::abs(s.y - a.y) < 8.0F;
        };
        return like(b) && like(c) && like(d);
    }

    void gather(Pixel& pixel, const Seen* upper, const Seen* lower, int x, int y) const {
        pixel.clear();
        const Seen &a = upper[0], &b = upper[1], &c = lower[0], &d = lower[1];
        const float acrossX = std::max(std::abs(b.x - a.x), std::abs(c.x - a.x)),
                    acrossY = std::max(std::abs(b.y - a.y), std::abs(c.y - a.y));
        if (even(a, b, c, d)) {
            if (a.surface < 0) return;
            const Look& look = view.stage().things.looks[static_cast<std::size_t>(a.look)];
            const float spanU = std::hypot(b.u - a.u, c.u - a.u) / kCoarse,
                        spanV = std::hypot(b.v - a.v, c.v - a.v) / kCoarse;
            for (int j = 0; j < kCoarse; ++j) {
                for (int i = 0; i < kCoarse; ++i) {
                    const float s = (static_cast<float>(i) + 0.5F) / kCoarse,
                                t = (static_cast<float>(j) + 0.5F) / kCoarse;
                    pixel.look(between(between(a, b, s), between(c, d, s), t), look, acrossX / kCoarse,
                               acrossY / kCoarse, spanU, spanV, 1.0F / (kCoarse * kCoarse));
                }
            }
            return;
        }
        for (int j = 0; j < kFine; ++j) {
            for (int i = 0; i < kFine; ++i) {
                const Seen s = view.seen(x + (i + 0.5) / kFine, y + (j + 0.5) / kFine);
                if (s.surface < 0) continue;
                pixel.look(s, view.stage().things.looks[static_cast<std::size_t>(s.look)],
                           std::min(acrossX, 2.0F) / kFine, std::min(acrossY, 2.0F) / kFine, 0.0F, 0.0F,
                           1.0F / (kFine * kFine));
            }
        }
    }

    void look(const std::stop_token& stop) {
        const Stage& stage = view.stage();
        const Size size = stage.camera.size;
        const auto corners = static_cast<std::size_t>(size.width) + 1;
        std::vector<Seen> grid(corners * (static_cast<std::size_t>(size.height) + 1));
        parallelFor(size.height + 1, [&](int y) {
            if (stop.stop_requested()) return;
            Seen* row = grid.data() + static_cast<std::size_t>(y) * corners;
            for (int x = 0; x <= size.width; ++x)
                row[x] = view.seen(x, y);
        });
        const auto count = static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
        albedo.resize(count);
        tint.resize(3 * count);
        firstTap.assign(count + 1, 0);
        std::vector<std::vector<Tap>> rows(static_cast<std::size_t>(size.height));
        parallelFor(size.height, [&](int y) {
            if (stop.stop_requested()) return;
            Pixel pixel(stage.projector.size);
            auto& own = rows[static_cast<std::size_t>(y)];
            for (int x = 0; x < size.width; ++x) {
                const Seen* upper = grid.data() + static_cast<std::size_t>(y) * corners + x;
                gather(pixel, upper, upper + corners, x, y);
                const auto i =
                    static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x);
                own.insert(own.end(), pixel.taps().begin(), pixel.taps().end());
                firstTap[i + 1] = static_cast<std::uint32_t>(pixel.taps().size());
                albedo[i] = pixel.albedo();
                for (std::size_t c = 0; c < 3; ++c)
                    tint[3 * i + c] = pixel.tint(c);
            }
        });
        if (stop.stop_requested()) return;
        for (std::size_t i = 1; i <= count; ++i)
            firstTap[i] += firstTap[i - 1];
        taps.reserve(firstTap.back());
        for (const auto& row : rows)
            taps.insert(taps.end(), row.begin(), row.end());
        if (stage.bounce > 0.0) bounce = SecondBounce(view.tree(), stage.camera, stage.cameraAt, stage.bounce);
    }
};

LightTransport::LightTransport(Stage stage, const std::stop_token& stop)
    : impl_(std::make_unique<Impl>(std::move(stage), stop)) {}
LightTransport::~LightTransport() = default;

const Stage& LightTransport::stage() const { return impl_->view.stage(); }
const std::vector<std::uint8_t>& LightTransport::tint() const { return impl_->tint; }
const std::vector<float>& LightTransport::albedo() const { return impl_->albedo; }

std::optional<Truth> LightTransport::truth(double x, double y) const { return impl_->view.truth(x, y); }

void LightTransport::shine(const std::vector<float>& light, double ambientLux, std::vector<float>& out) const {
    const Impl& it = *impl_;
    const Size size = it.view.stage().camera.size;
    out.resize(it.albedo.size());
    parallelFor((size.height + 31) / 32, [&](int band) {
        const auto width = static_cast<std::size_t>(size.width);
        const std::size_t begin = 32U * static_cast<std::size_t>(band) * width;
        const std::size_t end = std::min(it.albedo.size(), begin + 32U * width);
        const Tap* tap = it.taps.data() + it.firstTap[begin];
        for (std::size_t i = begin; i < end; ++i) {
            const Tap* const last = it.taps.data() + it.firstTap[i + 1];
            float sum = 0.0F;
            for (; tap != last; ++tap)
                sum += tap->weight * light[tap->pixel];
            out[i] = sum;
        }
    });
    const auto ambient = static_cast<float>(ambientLux);
    const std::vector<float> thrown = it.bounce.fallingOn(out);
    parallelFor(size.height, [&](int y) {
        const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width);
        for (int x = 0; x < size.width; ++x) {
            const std::size_t i = row + static_cast<std::size_t>(x);
            const float more = thrown.empty() ? 0.0F : it.bounce.at(thrown, x, y);
            out[i] += it.albedo[i] * (ambient + more);
        }
    });
}

}  // namespace ilf::devices::scene
