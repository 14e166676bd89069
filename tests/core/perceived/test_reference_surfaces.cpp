// The reference's surfaces: what hides what through the pupil, planes met where they are, depth maps and their edges.
#include "tests/core/perceived/reference_cases.h"
#include "tests/support/law.h"

using namespace ilf;
using namespace ilf::test;

namespace {

constexpr double kHalfPupil = 2e-3, kBehind = 0.02;
constexpr double kMiddleX = 80.0, kMiddleY = 60.0;

/// Part of the unit disc left of a line at `at`.
double leftOfLine(double at) {
    const double t = std::clamp(at, -1.0, 1.0);
    return 0.5 + (t * std::sqrt(1.0 - t * t) + std::asin(t)) / std::numbers::pi;
}

/// A card over the left half, before a wall; the eye looks at kHere, the lens rests: nothing is magnified.
Played cardAndWall(bool cardIsWhite, double card, double wall, double attended) {
    Document d = lookingAt(drawn([=](int x, int) { return (x < 80) == cardIsWhite; }), wall, attended);
    d.scene.scale.focalPixels = 6000.0;
    d.regions.push_back(Box<Region>(region("card", Look::blur, card, maskIn({0, 0, 80, 120}))));
    return through(d, 0.0);
}
/// In pixels, with its sign: where a ray through the pupil's right rim meets a surface.
double spread(double metres, double attended) {
    return 6000.0 * kHalfPupil * (1.0 / (attended + kBehind) - 1.0 / (metres + kBehind));
}

Document withBackground(Document d, const Distance& distance) {
    Region behind = *d.background;
    behind.distance = distance;
    d.background = Box<Region>(behind);
    return d;
}
Document withDepth(Document d, const std::function<double(double, double)>& metres) {
    std::vector<std::uint16_t> raw;
    for (int y = 0; y < kSmall.height; ++y) {
        for (int x = 0; x < kSmall.width; ++x)
            raw.push_back(static_cast<std::uint16_t>(std::lround(metres(x + 0.5, y + 0.5) / 2e-5)));
    }
    d.scene.depth = Box<DepthMap>(depthOf(Image<std::uint16_t>(kSmall, 1, std::move(raw)), 0.02_mm));
    return withBackground(std::move(d), FromDepthMap{});
}

/// A desk: 0.8 m at the top, 0.45 m at the bottom, and a little askew.
const PlaneDistance kDesk{{{{{0.0, 0.0}, 0.8_m}, {{160.0, 0.0}, 0.7_m}, {{80.0, 120.0}, 0.45_m}}}};

double worstApart(const ReferencePixels& a, const ReferencePixels& b) {
    double worst = 0.0;
    for (std::size_t i = 0; i < a.radiance.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c)
            worst = std::max(worst, std::abs(a.radiance[i][c] - b.radiance[i][c]));
    }
    return worst;
}

}  // namespace

TEST_CASE("reference: a card hides through the pupil what is behind it, as the two half planes do together") {
    std::vector<ViewPixel> row;
    for (int x = 62; x < 98; ++x) {
        if (x != 79 && x != 80) row.push_back({x, 60});
    }
    const double card = 0.35, wall = 1.0;
    // The eye looks between card and wall, beyond both, and nearer than both.
    for (const double attended : {0.5, 4.0, 0.25}) {
        const double near = spread(card, attended), far = spread(wall, attended);
        const ReferencePixels light = rays(cardAndWall(true, card, wall, attended), lookingHere(), row, 8192);
        const ReferencePixels behind = rays(cardAndWall(false, card, wall, attended), lookingHere(), row, 8192);
        double worst = 0.0, apartFromProduct = 0.0;
        for (std::size_t i = 0; i < row.size(); ++i) {
            const double out = row[i].x + 0.5 - kMiddleX;
            // A ray at the height h passes the card where out + near h > 0, and meets the wall (of which the picture
            // shows what the card leaves) where out + far h > 0.
            const auto part = [&](double r) { return r > 0.0 ? std::pair(-out / r, 1.0) : std::pair(-1.0, -out / r); };
            const auto [passFrom, passTo] = part(near);
            const auto [wallFrom, wallTo] = part(far);
            const auto share = [](double from, double to) { return std::max(0.0, leftOfLine(to) - leftOfLine(from)); };
            const double passing = share(passFrom, passTo);
            const double seen = share(std::max(passFrom, wallFrom), std::min(passTo, wallTo));
            worst = std::max(
                {worst, std::abs(light.radiance[i][0] - (1.0 - passing)), std::abs(behind.radiance[i][0] - seen)});
            apartFromProduct = std::max(apartFromProduct, std::abs(seen - passing * share(wallFrom, wallTo)));
        }
        MESSAGE("looking at ", attended, " m: worst ", worst, "; the product of both would be off by ",
                apartFromProduct);
        CHECK(worst < 4e-3);
        CHECK(apartFromProduct > 0.05);
    }
}

TEST_CASE("reference: seen through a pinhole, any stack of surfaces is the picture") {
    std::mt19937 random(5);
    const auto soft = [&](int x0, int y0) {
        Mask mask(kSmall);
        for (int row = 0; row < mask.rows(); ++row) {
            for (int column = 0; column < mask.columns(); ++column) {
                Tile tile;
                for (int y = 0; y < kTile; ++y) {
                    for (int x = 0; x < kTile; ++x) {
                        if (column * kTile + x < x0 || row * kTile + y < y0) continue;
                        if (column * kTile + x >= kSmall.width || row * kTile + y >= kSmall.height) continue;
                        tile.at(x, y) = static_cast<std::uint8_t>(random() % 256);
                    }
                }
                mask.setTile(column, row, boxed(tile));
            }
        }
        return mask;
    };
    Document d = withDepth(lookingAt(texture(kSmall, 7), 0.5, 0.5),
                           [](double x, double) { return x < 80.0 ? 0.4 : 0.55 + 0.001 * x; });
    d.regions.push_back(Box<Region>(region("a", Look::blur, 0.6, soft(20, 30))));
    Region desk = region("desk", Look::blur, 0.5, soft(60, 10));
    desk.distance = kDesk;
    d.regions.push_back(Box<Region>(desk));
    d.regions.push_back(Box<Region>(region("b", Look::blur, 0.6, soft(50, 50))));
    Played scene = through(d, 0.0);
    scene.plan.input.eye.pupil = Metre::fromSi(1e-12);
    const auto pixels = somePixels({1, 1, 159, 119}, 400);
    const ReferencePixels seen = rays(scene, lookingHere(), pixels, 2);
    const Radiance plain = plainView(d, 1.0);
    double worst = 0.0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            worst = std::max(worst, std::abs(seen.radiance[i][static_cast<std::size_t>(c)] -
                                             static_cast<double>(plain.at(pixels[i].x, pixels[i].y, c))));
        }
    }
    CHECK(worst < 1e-6);
}

TEST_CASE("reference: a plane is met where a ray crosses it") {
    const Document d = withBackground(lookingAt(texture(kSmall, 7), 0.5, 0.5), kDesk);
    const double power = 2.0, f = 2000.0, surplus = 1.0 / (0.5 + kBehind);
    const Played scene = through(d, power);
    const AffineVergence v = **affineVergence(*d.background);
    const Radiance picture = plainView(d, 1.0);
    const auto pixels = somePixels({40, 30, 120, 90}, 150);
    // Behind the lens a ray has the height p and the slope -(x - x0) / f + p surplus; before it h and u, so that the
    // point at w before the lens is h - w u. With 1 / w = v(x, y) there: a square equation in w.
    std::vector<std::array<double, 3>> model;
    for (const ViewPixel& pixel : pixels) {
        model.push_back(overDisc([&](double px, double py) {
            const auto before = [&](double out, double p) {
                const double slope = -out / f + surplus * p, h = p - kBehind * slope;
                return std::pair(h, slope + power * h);
            };
            const auto [hx, ux] = before(pixel.x + 0.5 - kMiddleX, kHalfPupil * px);
            const auto [hy, uy] = before(pixel.y + 0.5 - kMiddleY, kHalfPupil * py);
            const double a = v.at + v.dx * (kMiddleX - f * ux) + v.dy * (kMiddleY - f * uy);
            const double b =
                v.at * kBehind + v.dx * (kMiddleX * kBehind + f * hx) + v.dy * (kMiddleY * kBehind + f * hy) - 1.0;
            const double w = (-b + std::sqrt(b * b + 4.0 * a * kBehind)) / (2.0 * a);
            return bilinear(picture, kMiddleX + f * (hx - w * ux) / (w + kBehind),
                            kMiddleY + f * (hy - w * uy) / (w + kBehind));
        }));
    }
    const ReferencePixels seen = rays(scene, lookingHere(), pixels, 4096);
    const double dB = agreement(seen, model);
    MESSAGE("plane: ", dB, " dB, noise floor ", seen.noiseFloor_dB);
    CHECK(dB > 70.0);

    // Found on the way by another method: the same desk as a depth map.
    const Document measured =
        withDepth(lookingAt(texture(kSmall, 7), 0.5, 0.5), [&](double x, double y) { return 1.0 / v(x, y); });
    const double asMap = agreement(rays(through(measured, power), lookingHere(), pixels, 4096), seen.radiance);
    MESSAGE("the same as a depth map: ", asMap, " dB");
    CHECK(asMap > 70.0);
}

TEST_CASE("reference: a level plane, a level depth map and a constant distance are one") {
    const Document flat = lookingAt(texture(kSmall, 7), 0.6, 0.5);
    const PlaneDistance level{{{{{0.0, 0.0}, 0.6_m}, {{160.0, 0.0}, 0.6_m}, {{80.0, 120.0}, 0.6_m}}}};
    const auto pixels = somePixels({10, 10, 150, 110}, 100);
    const ReferencePixels seen = rays(through(flat, 1.5), lookingHere(), pixels, 256);
    CHECK(worstApart(seen, rays(through(withBackground(flat, level), 1.5), lookingHere(), pixels, 256)) < 1e-8);
    const Document map = withDepth(flat, [](double, double) { return 0.6; });
    CHECK(worstApart(seen, rays(through(map, 1.5), lookingHere(), pixels, 256)) < 1e-7);  // floats
}

TEST_CASE("reference: a depth map is torn where a near thing ends") {
    const PixelRect<CameraFrame> card{50, 35, 100, 80};
    Document flats = lookingAt(texture(kSmall, 7), 0.9, 0.5);
    Document map = withDepth(flats, [&](double x, double y) {
        return x > card.x0 && x < card.x1 && y > card.y0 && y < card.y1 ? 0.4 : 0.9;
    });
    flats.regions.push_back(Box<Region>(region("card", Look::blur, 0.4, maskIn(card))));
    const auto pixels = somePixels({30, 20, 120, 100}, 250);
    for (const double power : {0.0, 2.0}) {
        const ReferencePixels two = rays(through(flats, power), lookingHere(), pixels, 1024);
        const ReferencePixels one = rays(through(map, power), lookingHere(), pixels, 1024);
        const double dB = agreement(one, two.radiance);
        MESSAGE("card before a wall, as a depth map: ", dB, " dB, noise floor ", two.noiseFloor_dB);
        CHECK(dB > 45.0);
    }
}

TEST_CASE("reference: regions on one plane have no border that light passes") {
    Document d = withBackground(lookingAt(white(), 0.5, 0.5), kDesk);
    Region part = region("part", Look::blur, 0.5, maskIn({60, 40, 100, 80}));
    part.distance = kDesk;
    d.regions.push_back(Box<Region>(part));
    for (const auto& seen : rays(through(d, 2.0), lookingHere(), somePixels({40, 30, 120, 90}, 50), 64).radiance)
        CHECK(seen[0] == doctest::Approx(1.0).epsilon(1e-9));
}
