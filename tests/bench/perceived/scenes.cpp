#include "tests/bench/perceived/scenes.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/document/edit.h"
#include "core/document/shape.h"
#include "tests/bench/perceived/textures.h"

namespace ilf::bench {
namespace {

constexpr unsigned kSeed = 12345;
constexpr int kWidth = 1024;
/// An eye of 4 mm in a picture of 41 degrees: discs up to 11 px, as the prototype had them.
constexpr double kEyeField = 41.0;
/// 24 mm before a sensor 36 mm wide.
constexpr double kCameraField = 73.74;

Size sizeOf(int width) { return {width, width * 3 / 4}; }

Document blank(int width, double field, double wall_m, Look wall) {
    Scene scene;
    const Size size = sizeOf(width);
    scene.picture = Box<Picture>(mixedPicture(size, kSeed));
    scene.scale = {focalPixels(width, field), PixelScale::Source::typed};
    Document document = newDocument(std::move(scene));
    Region background = *document.background;
    background.look = wall;
    background.distance = ConstantDistance{Metre::fromSi(wall_m), {}};
    document.background = Box<Region>(background);
    document.rig.projector = size;
    document.rig.registration = registered(Homography<ProjectorFrame, CameraFrame>{});
    document.rig.waves = WaveMode::idealSine;
    return document;
}

Document withCamera(Document document, Metre focus) {
    document.wearer.camera = CameraObserver{.focusDistance = focus};
    document.wearer.lensAperture = 20.0_mm;  // does not limit f/1.4
    return document;
}

/// Places in units of the picture's width.
void add(Document& document, const std::string& name, Look look, double metres, double x, double y, double radius) {
    const double w = document.scene.size().width;
    Region region;
    region.id = region.name = name;
    region.look = look;
    region.distance = ConstantDistance{Metre::fromSi(metres), {}};
    region.mask = rasterised(Ellipse{{(x - radius) * w, (y - radius) * w}, {(x + radius) * w, (y + radius) * w}},
                             document.scene.size());
    document.regions.emplace_back(std::move(region));
}

/// So little error is allowed that each level is lit where the lens turns round: over a slot of a sixteenth of the
/// sweep a sine strays from its end by 0.0043 of its range, rms. No document asks for a blurShare of 0 otherwise.
Document withOneSlotEach(Document document, Dioptre high) {
    document.rig.powerBudget = 0.005 * high;
    document.rig.blurShare = 0.0;
    return document;
}

/// Takes what light such a plan has left beyond each level's best slot.
void keepBestSlots(Plan& plan) {
    for (std::size_t l = 0; l < plan.levels.size(); ++l) {
        Slot* best = nullptr;
        double most = 0.0;
        for (Slot& slot : plan.slots) {
            const auto lit = std::ranges::find(slot.lit, static_cast<int>(l), &LevelLight::level);
            if (lit == slot.lit.end()) continue;
            if (lit->weight > most) best = &slot, most = lit->weight;
            slot.lit.erase(lit);
        }
        if (!best) continue;
        best->lit.push_back({static_cast<int>(l), 1.0});
        plan.levels[l].slots = {best->index};
        plan.levels[l].exposure = 1.0;
        plan.levels[l].rmsError = best->rmsError;
    }
    plan.light = 1.0 / static_cast<double>(plan.slots.size());
}

/// Planned and compiled; with `previous`, light that no edit can have reached is shared with it.
Result<Shown> compiled(const Document& document, const Compiled* previous = nullptr) {
    auto planned = plan(planInput(document), previous ? &previous->plan : nullptr);
    if (!planned) return tl::unexpected(planned.error());
    if (document.rig.blurShare == 0.0 && planned->sweeps()) keepBestSlots(*planned);
    auto made = compile(document, *planned, previous);
    if (!made) return tl::unexpected(made.error());
    const auto kept = std::make_shared<const Compiled>(*std::move(made));
    return Shown{document, *std::move(planned), kept->program, kept};
}

/// Alpha such that the end of the sweep lies at `power`.
Result<Document> sweptTo(Document document, Dioptre power) {
    Document usual = document;
    usual.rig.powerBudget = Rig{}.powerBudget;
    usual.rig.blurShare = Rig{}.blurShare;
    const auto first = plan(planInput(usual));
    if (!first) return tl::unexpected(first.error());
    document.alpha = power - first->pS.value_or(power);
    return document;
}

Result<BenchScene> planned(std::string name, const Result<Document>& document, RegionId painted, RegionId movedRegion) {
    if (!document) return tl::unexpected(document.error());
    auto shown = compiled(*document);
    if (!shown) return tl::unexpected(shown.error());
    return BenchScene{std::move(name), *std::move(shown), {}, std::move(painted), std::move(movedRegion)};
}

/// The paper's distances before a wall at 2 m.
void addFour(Document& document, Look a, Look b, Look c, Look d) {
    add(document, "A", a, 0.25, 0.24, 0.49, 0.146);
    add(document, "B", b, 0.5, 0.51, 0.39, 0.137);
    add(document, "C", c, 0.5, 0.74, 0.49, 0.127);
    add(document, "D", d, 1.3, 0.59, 0.20, 0.117);
}

std::string lightWord(Light light) { return light == Light::oneSlotEach ? "" : "; many slots"; }
std::string widthWord(int width) { return width == kWidth ? "" : "; " + std::to_string(width) + " wide"; }

/// Everything at full light in every level.
void lightAll(Program& program, std::uint8_t value) {
    for (LightImage& image : program.images)
        image = LightImage(image.size(), value);
}

/// Where dabs go: round the painted region's middle, `out` of its half width and height away from it.
Point<CameraFrame> placeOfDab(const BenchScene& scene, const Document& document, double out, int step) {
    const Region* region = findRegion(document, scene.painted);
    const Size size = document.scene.size();
    const auto box = region && !region->mask.empty() ? region->mask.coveredPixels()
                                                     : PixelRect<CameraFrame>{0, 0, size.width, size.height};
    const double angle = 2.4 * step;  // turns of the golden angle: never the same place twice
    return {0.5 * (box.x0 + box.x1) + 0.5 * out * box.width() * std::cos(angle),
            0.5 * (box.y0 + box.y1) + 0.5 * out * box.height() * std::sin(angle)};
}

void changeValues(LightImage& image, const std::function<std::uint8_t(int, int, std::uint8_t)>& value,
                  PixelRect<CameraFrame> within) {
    const auto box = within.clipped(image.size());
    if (box.empty()) return;
    for (int row = box.y0 / kTile; row <= (box.y1 - 1) / kTile; ++row) {
        for (int column = box.x0 / kTile; column <= (box.x1 - 1) / kTile; ++column) {
            Tile tile = *image.tile(column, row);
            for (int y = 0; y < kTile; ++y)
                for (int x = 0; x < kTile; ++x)
                    tile.at(x, y) = value(column * kTile + x, row * kTile + y, tile.at(x, y));
            image.setTile(column, row, boxed(tile));
        }
    }
}

}  // namespace

std::size_t strongestLevel(const Plan& plan) {
    return static_cast<std::size_t>(std::ranges::max_element(plan.levels, {}, &Level::power) - plan.levels.begin());
}

Result<BenchScene> seamScene() {
    Document document = withCamera(blank(kWidth, kCameraField, 0.5, Look::focus), 0.5_m);
    document = withOneSlotEach(std::move(document), 2.0_D);
    document.seam = {Blending::linearPerceived, 10.0_mm};
    add(document, "disc", Look::blur, 0.5, 0.5, 0.375, 0.2);
    auto scene = planned("seam", sweptTo(document, 2.0_D), "disc", "disc");
    if (scene) scene->rays = 32768;  // its figure, 80 dB, lies above what 4096 can tell
    return scene;
}

Result<BenchScene> fourObjectsEye(int width, Light light) {
    Document document = blank(width, kEyeField, 2.0, Look::neutral);
    if (light == Light::oneSlotEach) document = withOneSlotEach(std::move(document), 2.5_D);
    addFour(document, Look::focus, Look::focus, Look::blur, Look::blur);
    auto scene = planned("four objects; eye" + widthWord(width) + lightWord(light), sweptTo(document, 2.5_D), "C", "D");
    if (scene) scene->request.attending = "B";
    return scene;
}

Result<BenchScene> fourObjectsCamera(int width, Light light) {
    Document document = withCamera(blank(width, kCameraField, 2.0, Look::neutral), 0.5_m);
    if (light == Light::oneSlotEach) document = withOneSlotEach(std::move(document), 2.5_D);
    addFour(document, Look::blur, Look::focus, Look::blur, Look::blur);
    return planned("four objects; camera" + widthWord(width) + lightWord(light), sweptTo(document, 2.5_D), "C", "D");
}

Result<BenchScene> fourSlotsCamera() {
    Document document = withCamera(blank(kWidth, kCameraField, 2.0, Look::focus), 2.0_m);
    addFour(document, Look::focus, Look::focus, Look::focus, Look::focus);
    // A sine passes the two levels in the middle of its sweep within one slot by more than the usual 0.1 D.
    document.rig.powerBudget = 0.3_D;
    return planned("four slots; camera", document, "C", "D");
}

Result<BenchScene> litTwice() {
    Document document = withOneSlotEach(withCamera(blank(kWidth, kCameraField, 2.0, Look::neutral), 0.5_m), 2.5_D);
    addFour(document, Look::blur, Look::focus, Look::blur, Look::blur);
    auto scene = planned("everything lit twice", sweptTo(document, 2.5_D), "C", "");
    if (!scene) return scene;
    // A camera focused at 5 m sees nothing sharp in either slot.
    Shown& shown = scene->shown;
    shown.document = withCamera(std::move(shown.document), 5.0_m);
    shown.plan.input.eye = eyeOptics(shown.document.wearer);
    lightAll(shown.program, 128);
    scene->byHand = true;
    return scene;
}

Result<BenchScene> slantedDesk() {
    Document document = blank(kWidth, kEyeField, 2.0, Look::focus);
    const PlaneDistance desk{{DistanceAnchor{{100.0, 760.0}, 0.42_m}, DistanceAnchor{{900.0, 760.0}, 0.42_m},
                              DistanceAnchor{{512.0, 260.0}, 0.9_m}}};
    const auto lie = [&](const std::string& name, Look look, const Shape& shape) {
        Region region;
        region.id = region.name = name;
        region.look = look;
        region.distance = desk;
        region.mask = rasterised(shape, document.scene.size());
        document.regions.emplace_back(std::move(region));
    };
    lie("page", Look::focus, Rectangle{{330.0, 400.0}, {640.0, 680.0}});
    lie("desk", Look::blur, Rectangle{{0.0, 260.0}, {1024.0, 768.0}});
    auto scene = planned("slanted desk", document, "desk", "");
    if (scene) scene->request.attending = "page";
    return scene;
}

Result<BenchScene> manyRegions(int count) {
    Document document = blank(kWidth, kEyeField, 2.5, Look::neutral);
    const int columns = count > 4 ? 4 : count, rows = (count + columns - 1) / columns;
    for (int i = 0; i < count; ++i) {
        const double part = count == 1 ? 0.5 : static_cast<double>(i) / (count - 1);
        const double metres = 1.0 / (1.0 / 0.35 + part * (1.0 / 2.0 - 1.0 / 0.35));
        // Neighbours overlap a little, so that surfaces hide each other.
        const double x = (i % columns + 0.5) / columns, y = 0.75 * (i / columns + 0.5) / rows;
        add(document, "R" + std::to_string(i), i % 2 == 0 ? Look::blur : Look::focus, metres, x, y,
            std::min(0.14, 0.56 / columns));
    }
    auto scene = planned(std::to_string(count) + " regions", document, "R0", count > 2 ? "R2" : "R0");
    if (scene && count > 1) scene->request.attending = "R1";
    return scene;
}

Result<BenchScene> nothingToBlur() {
    Document document = blank(kWidth, kEyeField, 2.0, Look::neutral);
    addFour(document, Look::focus, Look::focus, Look::focus, Look::focus);
    return planned("nothing to blur", document, "C", "D");
}

Result<BenchScene> splitLight(int slots) {
    auto scene = oneRadius(16.0);
    if (!scene) return scene;
    scene->name = "light in " + std::to_string(slots) + " slots";
    Plan& plan = scene->shown.plan;
    const Level strongest = plan.levels[strongestLevel(plan)];
    // A lens that hardly moves: every slot has a power of its own, all blur by 16 px within a few hundredths.
    const Dioptre low = strongest.power - 0.03_D;
    plan.waveform = idealSine(0.0_D, low, strongest.power, plan.waveform.rate, 0.0_s);
    scene->shown.program.waveform = plan.waveform;
    plan.levels.clear();
    scene->shown.program.images.clear();
    for (Slot& slot : plan.slots)
        slot.lit.clear();
    const Size size = scene->shown.document.scene.size();
    for (int s = 0; s < slots; ++s) {
        Level level = strongest;
        level.slots = {s};
        level.exposure = 1.0;
        Slot& slot = plan.slots[static_cast<std::size_t>(s)];
        slot.lit = {{s, 1.0}};
        slot.power = level.power = plan.waveform.powerAt(slot.middle());
        plan.levels.push_back(level);
        LightImage image(size);
        const PixelRect<CameraFrame> strip{size.width * s / slots, 0, size.width * (s + 1) / slots, size.height};
        changeValues(
            image,
            [&](int x, int y, std::uint8_t) {
                return static_cast<std::uint8_t>(x >= strip.x0 && x < strip.x1 && y < size.height ? 255 : 0);
            },
            strip);
        scene->shown.program.images.push_back(std::move(image));
    }
    plan.light = 1.0 / static_cast<double>(plan.slots.size());
    for (std::size_t s = 0; s < plan.slots.size(); ++s)
        scene->shown.program.imageOfSlot[s] = static_cast<int>(s) < slots ? static_cast<int>(s) : Program::kDark;
    scene->byHand = true;
    return scene;
}

Result<BenchScene> oneRadius(double radius) {
    Document document = withCamera(blank(kWidth, kCameraField, 0.5, Look::focus), 0.5_m);
    add(document, "all", Look::blur, 0.5, 0.5, 0.375, 2.0);
    // Defocus E with f_px D_e / 2 |E| = radius; at the lens it is E / (1 + d_Ee E) of the surface's own, to first
    // order.
    const EyeOptics eye = eyeOptics(document.wearer);
    const double wanted = radius / (0.5 * document.scene.scale.focalPixels * eye.pupil.si());
    auto swept = sweptTo(document, Dioptre::fromSi(wanted / (1.0 + eye.lensToPupil.si() * wanted)));
    return planned("radius " + std::to_string(static_cast<int>(std::lround(radius))), swept, "all", "");
}

Shown dimmed(const Shown& shown) {
    Shown result = shown;
    for (LightImage& image : result.program.images) {
        const Size size = image.size();
        changeValues(image,
                     [&](int x, int y, std::uint8_t v) {
                         const bool inside = x < size.width && y < size.height;
                         return static_cast<std::uint8_t>(inside && v > 1 ? v - 1 : v);
                     },
                     {0, 0, size.width, size.height});
    }
    return result;
}

Shown dabbedLight(const BenchScene& scene, const Shown& from, double diameter, int step) {
    Shown result = from;
    const auto at = placeOfDab(scene, scene.shown.document, 0.8, step);
    const double radius = 0.5 * diameter;
    const auto near = [&](double offset) { return static_cast<int>(std::floor(offset)); };
    changeValues(result.program.images[strongestLevel(from.plan)],
                 [&](int x, int y, std::uint8_t v) {
                     const bool inside = std::hypot(x + 0.5 - at.x, y + 0.5 - at.y) < radius;
                     return static_cast<std::uint8_t>(inside ? (v > 1 ? v / 2 : 200) : v);
                 },
                 {near(at.x - radius), near(at.y - radius), near(at.x + radius) + 1, near(at.y + radius) + 1});
    return result;
}

Result<Shown> dabbedMask(const BenchScene& scene, const Shown& from, double diameter, int step) {
    const Dab dab{placeOfDab(scene, scene.shown.document, 1.0, step), {0.5 * diameter, 0.8, 1.0}};
    const PaintMode mode = step % 2 == 0 ? PaintMode::erase : PaintMode::add;
    auto painted = edited(from.document, Paint{scene.painted, {dab}, mode, false});
    if (!painted) return tl::unexpected(painted.error());
    return compiled(*painted, from.compiled.get());
}

Result<Shown> moved(const BenchScene& scene, int step) {
    const Region* region = findRegion(scene.shown.document, scene.moved);
    if (!region) return fail(Fault::notFound, "This scene has no region to move.");
    const auto* constant = std::get_if<ConstantDistance>(&region->distance);
    if (!constant) return fail(Fault::notFound, "Only a region at one distance is moved.");
    const Distance nearer = ConstantDistance{constant->value / (1.0 + 0.02 * step), constant->tolerance};
    auto document = edited(scene.shown.document, SetDistance{scene.moved, nearer});
    if (!document) return tl::unexpected(document.error());
    return compiled(*document, scene.shown.compiled.get());
}

}  // namespace ilf::bench
