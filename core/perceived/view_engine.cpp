#include "core/perceived/view_engine.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include "core/base/elapsed.h"
#include "core/perceived/engine_cut.h"
#include "core/perceived/engine_raster.h"
#include "core/perceived/engine_state.h"

namespace ilf {
namespace {

using view::EngineLight;
using view::EngineLook;
using view::EngineScene;
using view::EngineSurface;
using view::kTileH;
using view::kTileW;
using view::Looks;
using view::PaddedPlane;
using view::TilePlane;
using view::ViewRect;

/// Surfaces whose blur differs by less than about half a pixel are blurred alike, however small it is.
constexpr double kAlike = 0.6;
using Clock = std::chrono::steady_clock;

PaddedPlane planeOf(const Radiance& albedo, std::size_t colour, view::TileCount tiles) {
    PaddedPlane plane(tiles.columns * kTileW, tiles.rows * kTileH);
    for (int y = 0; y < albedo.height(); ++y) {
        const float* from = albedo.row(y);
        float* to = plane.at(0, y);
        for (int x = 0; x < albedo.width(); ++x)
            to[x] = from[3 * x + static_cast<int>(colour)];
    }
    return plane;
}

Box<ViewTile> pictureTile(const EngineScene& scene, int tile) {
    ViewTile picture;
    const ViewRect rect = scene.tiles.rect(tile);
    for (std::size_t c = 0; c < 3; ++c) {
        for (int y = 0; y < kTileH; ++y) {
            std::copy_n(scene.albedo[c].at(rect.x0, rect.y0 + y), kTileW,
                        picture.v.data() + c * view::kTilePixels + static_cast<std::size_t>(y * kTileW));
        }
    }
    return Box<ViewTile>(picture);
}

/// Of a disc as it is seen, view pixels.
double seenRadius(const EngineLook& look) {
    const view::Appearance& green = look.shown.looks[1];
    return green.radius * green.magnification;
}

/// The nearer surface's alpha as points of the farther one meet it: x_j = c_j + (c_k + s_k (X - c_k) - c_j) / s_j, a
/// disc of the difference of both.
Looks asMet(const Looks& nearer, const Looks& farther) {
    Looks met;
    for (std::size_t c = 0; c < met.size(); ++c) {
        const view::Appearance &j = nearer[c], &k = farther[c];
        // x -> X magnifies by s about a centre of its own
        double s = j.magnification / k.magnification;
        if (std::abs(1.0 - s) < 1e-9) s = 1.0 - 1e-9;
        met[c].radius = (j.radius * j.magnification - k.radius * k.magnification) / j.magnification;
        met[c].magnification = s;
        // Fixed point: X = c_k + (c_j + s_j (x - c_j) - c_k) / s_k with X = x.
        const auto fixed = [&](double cj, double ck) {
            const double shift = (cj - ck) * (1.0 - j.magnification) / k.magnification;
            // A shift without magnification is one about a centre far away.
            return shift == 0.0 ? ck : ck + shift / (1.0 - s);
        };
        met[c].centreX = fixed(j.centreX, k.centreX);
        met[c].centreY = fixed(j.centreY, k.centreY);
    }
    return met;
}

}  // namespace

struct ViewEngine::State {
    int threads = 2;
    EngineScene scene;
    view::SpareTiles spareTiles;
    std::optional<view::SceneCut> cut;
    std::vector<view::LightRaster> rasters;
    std::optional<view::LightMap> lightMap;
    PerceivedView last;
    std::vector<Box<ViewTile>> plainTiles;  ///< of the picture; empty until one is shown
    std::vector<bool> pending;              ///< tiles that a cancelled view left to be worked out
    // What the last view was of.
    bool seen = false;
    Document document;
    Plan plan;
    Program program;
    ViewRequest request;
    Box<Picture> picture;
    bool plain = false;
    view::PupilShift shift;

    void geometry(const Document& document, const Plan& plan, const ViewRequest& request, const view::Setting& setting);
    void surfaces(const Document& document, const ViewRequest& request, bool moved, bool anew);
    bool remasked(const Document& document, ViewRect rect) const;
    void addLight(const view::PowerLight& power, const std::vector<std::size_t>& takingPart,
                  const std::function<Looks(Metre, Dioptre)>& looksAt, int colours);
    void hiding(EngineLight& light, int cells);
    TilePlane sharesPlane();
    int cellsAcross() const;
    void light(const Document& document, const Program& program, const view::Setting& setting, bool all);
};

/// Surfaces, the powers they are lit at and how they look at each of them.
void ViewEngine::State::geometry(const Document& now, const Plan& planned, const ViewRequest& asked,
                                 const view::Setting& setting) {
    scene.rules = view::rulesOf(asked.rung);
    const auto colour = view::colourShifts(planned, asked);
    const int colours = asked.chromatic && colour != std::array<Dioptre, 3>{} ? 3 : 1;
    const PixelRect<view::ViewFrame> window{0, 0, scene.size.width, scene.size.height};
    scene.lensField = asked.lensField && !planned.input.camera;
    const double pixelsPerMetreAcross =
        now.scene.scale.focalPixels * setting.scale.nominal / planned.input.eye.lensToPupil.si();
    scene.lensRadius_px = 0.5 * now.wearer.lensAperture.si() * pixelsPerMetreAcross;
    scene.pupilRadius_px = 0.5 * planned.input.eye.pupil.si() * pixelsPerMetreAcross;

    const auto looksAt = [&](Metre distance, Dioptre power) {
        Looks looks;
        for (std::size_t c = 0; c < 3; ++c) {
            looks[c] = view::appearance(now, planned, asked, setting.attention, setting.scale, window, distance, power,
                                        colour[c]);
        }
        return looks;
    };
    // A dioptre moves what lies off the centre (the rms of the view) by this much, or blurs it, whichever is more.
    const double moved_px =
        planned.input.eye.lensToPupil.si() * std::hypot(scene.size.width, scene.size.height) / std::sqrt(12.0);
    const double blurred_px = 0.25 * now.scene.scale.focalPixels * setting.scale.nominal * planned.input.eye.pupil.si();
    const double moves_px = std::max(moved_px, blurred_px);
    for (EngineLight& light : scene.lights) {
        for (EngineLook& look : light.looks) {
            if (!look.averaged[0].empty()) {
                scene.spareAverages[view::averagedAt(look.shown.placing.coarse)].push_back(
                    {std::move(look.averaged), std::move(look.averagedDark)});
            }
            for (TilePlane* plane : {&look.visible, &look.passing}) {
                if (!plane->empty()) scene.spareShares.push_back(std::move(*plane));
            }
        }
    }
    scene.lights.clear();
    for (const view::PowerSpread& spread : view::powerSpreads(planned)) {
        // Surfaces that are blurred anyway need fewer powers: by factors of two, so that most share theirs.
        std::map<int, std::vector<std::size_t>> byCare;
        for (std::size_t k = 0; k < scene.surfaces.size(); ++k) {
            const double radius = std::abs(looksAt(scene.surfaces[k].distance, spread.mean)[1].radius);
            byCare[static_cast<int>(std::log2(std::max(1.0, radius)))].push_back(k);
        }
        for (const auto& [care, surfaces] : byCare) {
            const auto limit = Dioptre::fromSi(scene.rules.spread_px * std::exp2(care) / moves_px);
            for (const view::PowerLight& power : view::powerLights(spread, limit))
                addLight(power, surfaces, looksAt, colours);
        }
    }
    const int cells = cellsAcross();
    scene.cells = cells > 1 ? view::pupilCells(cells) : std::vector<view::PupilCell>{};
    for (EngineLight& light : scene.lights)
        hiding(light, cells);
}

/// One power, and the surfaces whose light is shown at it.
void ViewEngine::State::addLight(const view::PowerLight& power, const std::vector<std::size_t>& takingPart,
                                 const std::function<Looks(Metre, Dioptre)>& looksAt, int colours) {
    // Care classes often come to the same powers: then they are one light.
    for (EngineLight& light : scene.lights) {
        if (light.light != power) continue;
        for (const std::size_t k : takingPart)
            light.looks[k].takesPart = true;
        return;
    }
    EngineLight& light = scene.lights.emplace_back(EngineLight{power, {}});
    for (const EngineSurface& surface : scene.surfaces) {
        EngineLook& look = light.looks.emplace_back();
        look.shown = view::shown(looksAt(surface.distance, power.power), colours, scene.tiles, scene.rules);
        look.takesPart = false;
    }
    for (const std::size_t k : takingPart)
        light.looks[k].takesPart = true;
}

/// Who hides whom in one light, and where that is settled.
void ViewEngine::State::hiding(EngineLight& light, int cells) {
    for (std::size_t k = 1; k < scene.surfaces.size(); ++k) {
        EngineLook& farther = light.looks[k];
        if (!farther.takesPart) continue;
        for (std::size_t j = 0; j < k; ++j) {
            if (scene.surfaces[j].sloped && scene.surfaces[k].sloped) continue;  // they add up
            EngineLook& nearer = light.looks[j];
            const double a = seenRadius(nearer), b = seenRadius(farther);
            const double smaller = std::min(std::abs(a), std::abs(b));
            if (std::abs(a - b) < std::max(kAlike, smaller / cells)) {
                farther.visibleBehind.push_back(
                    {static_cast<int>(j),
                     view::shown(asMet(nearer.shown.looks, farther.shown.looks), 1, scene.tiles, scene.rules)});
            } else {
                farther.passedBy.push_back(static_cast<int>(j));
                nearer.hides = true;
                if (cells > 1 && !nearer.shown.sharp && !farther.shown.sharp) {
                    if (nearer.shown.kernels.size() == 1) view::addCells(nearer.shown, scene.cells);
                    if (farther.shown.kernels.size() == 1) view::addCells(farther.shown, scene.cells);
                }
            }
        }
        if (!farther.visibleBehind.empty()) farther.visible = sharesPlane();
    }
    for (EngineLook& look : light.looks) {
        if (look.hides) look.passing = sharesPlane();
    }
}

/// All of it is worked out next: what a spare one holds does not matter.
TilePlane ViewEngine::State::sharesPlane() {
    if (scene.spareShares.empty()) return {scene.tiles, 1.0F};
    TilePlane spare = std::move(scene.spareShares.back());
    scene.spareShares.pop_back();
    return spare;
}

/// How finely the pupil is cut: by the largest blur of which two surfaces differ.
int ViewEngine::State::cellsAcross() const {
    double largest = 0.0;
    for (const EngineLight& light : scene.lights) {
        for (std::size_t k = 1; k < light.looks.size(); ++k) {
            for (std::size_t j = 0; j < k && light.looks[k].takesPart; ++j) {
                largest = std::max(
                    largest, std::min(std::abs(seenRadius(light.looks[j])), std::abs(seenRadius(light.looks[k]))));
            }
        }
    }
    const view::RungRules& rules = scene.rules;
    if (rules.mostCells < 2) return 1;
    return std::clamp(static_cast<int>(std::ceil(2.0 * largest / rules.cell_px)), rules.fewestCells, rules.mostCells);
}

/// At full size tile by tile where masks changed; at others all of it, and then what differs.
void ViewEngine::State::surfaces(const Document& now, const ViewRequest& asked, bool moved, bool anew) {
    if (moved) {
        scene.surfaces.resize(cut->surfaces().size());
        for (std::size_t k = 0; k < scene.surfaces.size(); ++k) {
            EngineSurface& made = scene.surfaces[k];
            made.region = cut->surfaces()[k].region;
            made.distance = cut->surfaces()[k].distance;
            made.sloped = cut->surfaces()[k].sloped;
            if (made.alpha.empty()) made.alpha = TilePlane(scene.tiles, 0.0F);
        }
    }
    for (EngineSurface& surface : scene.surfaces)
        surface.changed.clear();
    std::vector<int> tiles;
    for (int tile = 0; tile < scene.tiles.count(); ++tile) {
        const ViewRect rect = scene.tiles.rect(tile);
        if (anew || asked.scale != 1.0 || remasked(now, rect)) tiles.push_back(tile);
    }
    if (tiles.empty()) return;
    const std::vector<Radiance> resized = scene.size == now.scene.size()
                                              ? std::vector<Radiance>{}
                                              : view::pictureShares(*cut, now.scene.size(), scene.size, threads);
    std::vector<std::vector<std::pair<std::size_t, ViewRect>>> changed(tiles.size());
    view::shareOut(static_cast<int>(tiles.size()), threads, [&](int i) {
        const auto n = static_cast<std::size_t>(i);
        const ViewRect rect = scene.tiles.rect(tiles[n]);
        thread_local view::SceneCut::Tiles shares;
        if (resized.empty()) {
            cut->shares(rect.x0, rect.y0, shares);
        } else {
            shares.values.resize(scene.surfaces.size());
            shares.touched.assign(scene.surfaces.size(), true);
            for (std::size_t k = 0; k < scene.surfaces.size(); ++k) {
                shares.values[k].fill(0.0F);
                for (int y = rect.y0; y < std::min(rect.y1, scene.size.height); ++y) {
                    std::copy_n(resized[k].row(y) + rect.x0, std::min(kTileW, scene.size.width - rect.x0),
                                shares.values[k].data() + (y - rect.y0) * kTileW);
                }
            }
        }
        cut->toAlphas(shares);
        for (std::size_t k = 0; k < scene.surfaces.size(); ++k) {
            TilePlane& alpha = scene.surfaces[k].alpha;
            const ViewRect part =
                shares.touched[k] ? alpha.set(tiles[n], shares.values[k].data()) : alpha.fill(tiles[n], 0.0F);
            if (!part.empty()) changed[n].emplace_back(k, part);
        }
    });
    for (const auto& one : changed) {
        for (const auto& [k, part] : one)
            scene.surfaces[k].changed.push_back(part);
    }
}

/// A mask differs from the one of the view before somewhere under these pixels (of the picture).
bool ViewEngine::State::remasked(const Document& now, ViewRect rect) const {
    const int column = rect.x0 / kTile, row = rect.y0 / kTile;
    return !std::ranges::equal(now.regions, document.regions, [&](const Box<Region>& a, const Box<Region>& b) {
        if (a.same(b)) return true;
        const Mask &before = a->mask, &after = b->mask;
        if (before.empty() || after.empty()) return before.empty() == after.empty();
        return before.tile(column, row).same(after.tile(column, row));
    });
}

namespace {

bool meet(const PixelRect<ProjectorFrame>& a, const PixelRect<ProjectorFrame>& b) {
    return a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1;
}

}  // namespace

void ViewEngine::State::light(const Document& now, const Program& played, const view::Setting& setting, bool all) {
    std::size_t levels = 0;
    for (const EngineLight& one : scene.lights)
        levels = std::max(levels, static_cast<std::size_t>(one.light.level + 1));
    if (all || rasters.size() != levels) {
        rasters.assign(levels, {});
        scene.lightOfLevel.clear();
        for (std::size_t level = 0; level < levels; ++level)
            scene.lightOfLevel.emplace_back(scene.tiles, 0.0F);
    }
    scene.changedLight.assign(levels, {});
    const PixelMap map = pixelMap(now);
    const auto toCamera = map.nearest().inverted();
    if (!lightMap || !lightMap->isFor(map, setting.scale, scene.size, played.projector))
        lightMap.emplace(map, setting.scale, scene.size, played.projector);
    for (std::size_t level = 0; level < levels; ++level) {
        std::vector<bool> marked(static_cast<std::size_t>(scene.tiles.count()), false);
        const auto changed = rasters[level].update(played.images[level]);
        for (const auto& rect : changed) {
            if (all) break;
            if (map.dense()) {
                for (std::size_t tile = 0; tile < marked.size(); ++tile)
                    marked[tile] = marked[tile] || meet(lightMap->touched[tile], rect);
                continue;
            }
            // A projector pixel lights what lies between its neighbours' centres.
            ViewRect reached{0, 0, scene.size.width, scene.size.height};
            double x0 = 1e30, y0 = 1e30, x1 = -1e30, y1 = -1e30;
            bool within = true;  // this side of the registration's horizon
            for (const double x : {rect.x0 - 1.0, rect.x1 + 1.0}) {
                for (const double y : {rect.y0 - 1.0, rect.y1 + 1.0}) {
                    const auto at = toCamera({x, y});
                    within = within && toCamera.m[6] * x + toCamera.m[7] * y + toCamera.m[8] > 0.0;
                    x0 = std::min(x0, at.x * setting.scale.x);
                    x1 = std::max(x1, at.x * setting.scale.x);
                    y0 = std::min(y0, at.y * setting.scale.y);
                    y1 = std::max(y1, at.y * setting.scale.y);
                }
            }
            const auto bounded = [](double v, int limit) { return std::clamp(v, -1.0, limit + 1.0); };
            if (within) {
                reached = {static_cast<int>(std::floor(bounded(x0, scene.size.width))) - 1,
                           static_cast<int>(std::floor(bounded(y0, scene.size.height))) - 1,
                           static_cast<int>(std::ceil(bounded(x1, scene.size.width))) + 1,
                           static_cast<int>(std::ceil(bounded(y1, scene.size.height))) + 1};
            }
            scene.tiles.over(reached, [&](int tile) { marked[static_cast<std::size_t>(tile)] = true; });
        }
        std::vector<int> tiles;
        for (int tile = 0; tile < scene.tiles.count(); ++tile) {
            if (all || marked[static_cast<std::size_t>(tile)]) tiles.push_back(tile);
        }
        std::vector<ViewRect> rects(tiles.size());
        view::shareOut(static_cast<int>(tiles.size()), threads, [&](int i) {
            const auto n = static_cast<std::size_t>(i);
            std::array<float, view::kTilePixels> values;
            rasters[level].sample(values.data(), scene.tiles.rect(tiles[n]), *lightMap);
            rects[n] = scene.lightOfLevel[level].set(tiles[n], values.data());
        });
        for (const ViewRect& rect : rects) {
            if (!rect.empty()) scene.changedLight[level].push_back(rect);
        }
    }
}

ViewEngine::ViewEngine(int threads) : state_(std::make_unique<State>()) { state_->threads = threads; }
ViewEngine::~ViewEngine() = default;
ViewEngine::ViewEngine(ViewEngine&&) noexcept = default;
ViewEngine& ViewEngine::operator=(ViewEngine&&) noexcept = default;

Result<PerceivedView> ViewEngine::see(const Document& document, const Plan& plan, const Program& program,
                                      const ViewRequest& request, const std::function<bool()>& cancelled) {
    State& s = *state_;
    EngineScene& scene = s.scene;
    const bool samePlan = s.seen && s.plan == plan;
    const bool sameDocument = s.seen && s.document == document;
    const bool sameRequest = s.seen && s.request == request;
    PerceivedView& view = s.last;
    if (samePlan && sameDocument && sameRequest && s.program == program && view.complete) {
        view.counters = ViewCounters{};
        view.counters.tiles = view.counters.unchanged = scene.tiles.count();
        view.counters.lights = static_cast<int>(scene.lights.size());
        return view;
    }
    const auto setting = view::setting(document, plan, program, request);
    if (!setting) return tl::unexpected(setting.error());

    ViewCounters counters;
    auto start = Clock::now();
    const bool anew = !s.seen || scene.size != setting->scale.size;
    const bool switched = s.seen && s.plain != setting->plain;  // what a plain view skipped is out of date
    const bool newPicture = anew || !s.picture.same(document.scene.picture) || s.request.scale != request.scale;
    if (anew) {
        scene = EngineScene{};
        s.cut.reset();
        s.rasters.clear();
        s.lightMap.reset();
        scene.size = setting->scale.size;
        scene.tiles = view::tileCount(scene.size);
        view = {};
        view.size = scene.size;
        view.columns = scene.tiles.columns;
        view.rows = scene.tiles.rows;
        view.tiles.assign(static_cast<std::size_t>(scene.tiles.count()), Box<ViewTile>(ViewTile{}));
        s.pending.assign(view.tiles.size(), false);
    }
    s.seen = false;  // until this one is whole: a throw or a refusal leaves nothing half done behind
    if (newPicture) {
        const Radiance albedo = view::albedo(document, setting->scale);
        for (std::size_t c = 0; c < 3; ++c)
            scene.albedo[c] = planeOf(albedo, c, scene.tiles);
        scene.averagedAlbedo = {};
        s.plainTiles.assign(static_cast<std::size_t>(scene.tiles.count()), {});
    }
    bool all = newPicture || switched;
    if (!setting->plain) {
        const double step = view::bandStep(document, plan, request.scale, request.rung == Rung::dragging ? 2.0 : 1.0);
        view::SceneCut cut(document, plan, step);
        const view::PupilShift shift = view::pupilShiftOf(document, plan, request);
        const bool geometry = all || shift != s.shift || !samePlan || !sameRequest || !s.cut || !s.cut->sameBut(cut) ||
                              s.document.scene.scale != document.scene.scale || s.document.wearer != document.wearer ||
                              s.document.rig != document.rig;
        const bool reshared = all || !s.cut || !(s.cut->sameBut(cut) || s.cut->sameShares(cut));
        s.cut = std::move(cut);
        s.shift = shift;
        s.surfaces(document, request, geometry, reshared);
        if (geometry) {
            s.geometry(document, plan, request, *setting);
            all = true;
        }
        counters.geometry_ms += millisecondsSince(start);
        start = Clock::now();
        s.light(document, program, *setting,
                newPicture || switched || s.document.rig.registration != document.rig.registration ||
                    s.document.rig.projector != document.rig.projector);
        counters.light_ms += millisecondsSince(start);
        start = Clock::now();
        view::updateVisibility(scene, all, s.threads);
        counters.geometry_ms += millisecondsSince(start);
        start = Clock::now();
        view::updateAveraged(scene, all, s.threads);
        counters.light_ms += millisecondsSince(start);
    }
    start = Clock::now();

    if (all) s.pending.assign(s.pending.size(), true);
    for (const EngineLight& light : scene.lights) {
        for (std::size_t k = 0; k < scene.surfaces.size() && !all && !setting->plain; ++k) {
            const EngineLook& look = light.looks[k];
            if (!look.takesPart && !look.hides) continue;
            const auto mark = [&](ViewRect rect) {
                scene.tiles.over(rect, [&](int tile) { s.pending[static_cast<std::size_t>(tile)] = true; });
            };
            for (const ViewRect& rect : scene.surfaces[k].changed) {
                mark(rect);
                mark(look.shown.reached(rect));
            }
            for (const ViewRect& rect : look.changedVisible)
                mark(look.shown.reached(rect));
            for (const ViewRect& rect : look.changedPassing)
                mark(rect);
            if (light.light.level != view::Exposure::kAmbient) {
                for (const ViewRect& rect : scene.changedLight[static_cast<std::size_t>(light.light.level)])
                    mark(look.shown.reached(rect));
            }
        }
    }
    std::vector<int> tiles;
    for (std::size_t i = 0; i < s.pending.size(); ++i) {
        if (s.pending[i]) tiles.push_back(static_cast<int>(i));
    }
    std::vector<ViewCounters> each(tiles.size());
    bool complete = true;
    constexpr std::size_t kAtOnce = 64;
    std::size_t done = 0;
    for (; done < tiles.size(); done += kAtOnce) {
        if (cancelled && cancelled()) {
            complete = false;
            break;
        }
        const std::size_t count = std::min(kAtOnce, tiles.size() - done);
        view::shareOut(static_cast<int>(count), s.threads, [&](int i) {
            const std::size_t n = done + static_cast<std::size_t>(i);
            const int tile = tiles[n];
            Box<ViewTile>& seen = view.tiles[static_cast<std::size_t>(tile)];
            if (setting->plain) {
                Box<ViewTile>& plainTile = s.plainTiles[static_cast<std::size_t>(tile)];
                if (!plainTile) plainTile = pictureTile(scene, tile);
                seen = plainTile;
                ++each[n].plain;
            } else {
                seen = view::tileSeen(scene, tile, s.spareTiles, each[n]);
                ++each[n].computed;
            }
        });
        for (std::size_t i = done; i < done + count; ++i)
            s.pending[static_cast<std::size_t>(tiles[i])] = false;
    }
    for (const ViewCounters& one : each) {
        counters.computed += one.computed;
        counters.plain += one.plain;
        counters.dark += one.dark;
        counters.blurred += one.blurred;
        counters.sharp += one.sharp;
        counters.unlit += one.unlit;
        counters.hidden += one.hidden;
        counters.conflicts += one.conflicts;
    }
    counters.tiles = scene.tiles.count();
    counters.left = static_cast<int>(tiles.size() - std::min(done, tiles.size()));
    counters.unchanged = counters.tiles - static_cast<int>(tiles.size());
    counters.lights = setting->plain ? 0 : static_cast<int>(scene.lights.size());
    for (const LightImage& image : program.images)
        counters.darkLights += !setting->plain && image.blank() ? 1 : 0;
    counters.tiles_ms = millisecondsSince(start);
    view.rung = request.rung;
    view.complete = complete;
    view.counters = counters;
    s.document = document;
    s.plan = plan;
    s.program = program;
    s.request = request;
    s.picture = document.scene.picture;
    s.plain = setting->plain;
    s.seen = true;
    return view;
}

Radiance PerceivedView::radiance() const {
    std::vector<float> pixels(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) * 3);
    for (int y = 0; y < size.height; ++y) {
        float* out = pixels.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) * 3;
        for (int column = 0; column < columns; ++column) {
            const auto& v = tile(column, y / ViewTile::kHeight)->v;
            const int width = std::min(ViewTile::kWidth, size.width - column * ViewTile::kWidth);
            for (int c = 0; c < 3; ++c) {
                const float* row = v.data() + (c * ViewTile::kHeight + y % ViewTile::kHeight) * ViewTile::kWidth;
                for (int x = 0; x < width; ++x)
                    out[(column * ViewTile::kWidth + x) * 3 + c] = row[x];
            }
        }
    }
    return Radiance(size, 3, std::move(pixels));
}

}  // namespace ilf
