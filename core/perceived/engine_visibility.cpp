// Who hides whom, worked out tile by tile where a surface's outline changed; and light averaged for coarse discs.
#include <algorithm>
#include <array>
#include <utility>

#include "core/perceived/engine_state.h"

namespace ilf::view {
namespace {

/// One tile to be worked out.
struct Job {
    std::size_t light = 0, surface = 0;
    int tile = 0;
};

/// Marks tiles once.
class Marks {
public:
    explicit Marks(TileCount tiles) : tiles_(tiles), marked_(static_cast<std::size_t>(tiles.count())) {}
    void mark(ViewRect pixels) {
        tiles_.over(pixels, [&](int tile) { marked_[static_cast<std::size_t>(tile)] = true; });
    }
    void markAll() { std::fill(marked_.begin(), marked_.end(), true); }
    template <class Visit>
    void each(const Visit& visit) const {
        for (std::size_t i = 0; i < marked_.size(); ++i) {
            if (marked_[i]) visit(static_cast<int>(i));
        }
    }

private:
    TileCount tiles_;
    std::vector<bool> marked_;
};

/// into -= what `shown` shows of a surface's alpha in a tile; false if it shows nothing there.
bool takeAway(const EngineScene& scene, const EngineSurface& surface, const Shown& shown, int tile,
              std::array<float, kTilePixels>& into) {
    Workspace& work = workspace();
    const std::array<const TilePlane*, 1> alpha{&surface.alpha};
    const ViewRect pixels = shown.pixels(scene.tiles, tile), lit = litBox(pixels, alpha);
    const ViewRect part = shown.litSamples(scene.tiles, tile, lit);
    if (lit.empty() || part.empty()) return false;
    if (surface.alpha.uniformOver(pixels, 1.0F)) {
        for (float& value : into)
            value -= 1.0F;
        return true;
    }
    if (shown.still) {
        const Covered covered = coveredOver(work, scene.tiles.rect(tile), alpha);
        for (int y = 0; y < kTileH; ++y) {
            for (int x = 0; x < kTileW; ++x)
                into[static_cast<std::size_t>(y * kTileW + x)] -=
                    covered.mask ? covered.mask[y * covered.stride + x] : covered.even;
        }
        return true;
    }
    if (!sumSource(work, shown, part, coverageOf(work, surface, shown, part))) return false;
    addSummed(into.data(), work, shown, shown.kernel(0, 1), scene.tiles, tile, part, nullptr, -1.0F);
    return true;
}

/// Shares this near to 0 and 1 are so but for rounding: most tiles are then uniform.
constexpr float kRounding = 1e-4F;

/// One tile of averages of what `planes` cover, or of `values` under it; dark where nothing does.
void averageInto(PaddedPlane& into, int coarse, ViewRect rect, const Covered& covered, const PaddedPlane* values) {
    averageTile(into.at(rect.x0 / coarse, rect.y0 / coarse), into.stride(), coarse, covered.mask, covered.stride,
                covered.even, values ? values->at(covered.window.x0, covered.window.y0) : nullptr,
                values ? values->stride() : 0);
}

void fill(PaddedPlane& into, int coarse, ViewRect rect, float value) {
    for (int y = 0; y < kTileH / coarse; ++y)
        std::fill_n(into.at(rect.x0 / coarse, rect.y0 / coarse + y), kTileW / coarse, value);
}

void copyTile(PaddedPlane& into, const PaddedPlane& from, int coarse, ViewRect rect) {
    for (int y = 0; y < kTileH / coarse; ++y) {
        std::copy_n(from.at(rect.x0 / coarse, rect.y0 / coarse + y), kTileW / coarse,
                    into.at(rect.x0 / coarse, rect.y0 / coarse + y));
    }
}

PaddedPlane averagedPlane(TileCount tiles, int coarse) {
    return {tiles.columns * kTileW / coarse, tiles.rows * kTileH / coarse};
}

/// Alpha over 2 x 2 and 4 x 4 pixels, for the looks that ask for it.
void updateAveragedAlpha(EngineScene& scene, bool all, int threads) {
    std::vector<Job> jobs;  // light: 0 half, 1 quarter
    for (std::size_t k = 0; k < scene.surfaces.size(); ++k) {
        EngineSurface& surface = scene.surfaces[k];
        for (std::size_t which = 0; which < 2; ++which) {
            if (surface.averaged[which].empty()) continue;
            Marks marks(scene.tiles);
            if (all) marks.markAll();
            for (const ViewRect& rect : surface.changed)
                marks.mark(rect.grown(averagingLead(kCoarse[which])));
            marks.each([&](int tile) { jobs.push_back({which, k, tile}); });
        }
    }
    shareOut(static_cast<int>(jobs.size()), threads, [&](int i) {
        const Job& job = jobs[static_cast<std::size_t>(i)];
        EngineSurface& surface = scene.surfaces[job.surface];
        const std::array<const TilePlane*, 1> alpha{&surface.alpha};
        const int coarse = kCoarse[job.light];
        const ViewRect rect = scene.tiles.rect(job.tile), window = rect.grown(averagingLead(coarse));
        if (litBox(window, alpha).empty()) return fill(surface.averaged[job.light], coarse, rect, 0.0F);
        if (evenOver(window, alpha) == 1.0F) return fill(surface.averaged[job.light], coarse, rect, 1.0F);
        averageInto(surface.averaged[job.light], coarse, rect, maskOver(workspace(), window, alpha), nullptr);
    });
}

/// Which surfaces' alphas are asked for as averages; makes room for those.
void makeRoomForAverages(EngineScene& scene) {
    std::vector<std::array<bool, 2>> asked(scene.surfaces.size());
    const auto ask = [&](const Shown& shown, std::size_t surface) {
        if (shown.placing.coarse != 1) asked[surface][averagedAt(shown.placing.coarse)] = true;
    };
    for (const EngineLight& light : scene.lights) {
        for (std::size_t k = 0; k < light.looks.size(); ++k) {
            if (light.looks[k].hides) ask(light.looks[k].shown, k);
            for (const Before& before : light.looks[k].visibleBehind)
                ask(before.shown, static_cast<std::size_t>(before.nearer));
        }
    }
    for (std::size_t k = 0; k < asked.size(); ++k) {
        for (std::size_t which = 0; which < 2; ++which) {
            PaddedPlane& plane = scene.surfaces[k].averaged[which];
            if (!asked[k][which]) plane = {};
            if (asked[k][which] && plane.empty()) plane = averagedPlane(scene.tiles, kCoarse[which]);
        }
    }
}

/// What nearer surfaces blurred alike leave of a farther one's points in a tile; false: all of it. Constant surfaces
/// hide what others let pass; bands of a slope hide together.
bool leaveVisible(const EngineScene& scene, const EngineLook& look, int tile, std::array<float, kTilePixels>& shares) {
    std::array<float, kTilePixels> one, slope;
    slope.fill(1.0F);
    bool any = false, sloped = false;
    const auto hide = [&](const std::array<float, kTilePixels>& left) { shareWithin(shares.data(), left.data()); };
    for (const Before& before : look.visibleBehind) {
        const EngineSurface& nearer = scene.surfaces[static_cast<std::size_t>(before.nearer)];
        if (!nearer.sloped) one.fill(1.0F);
        if (!takeAway(scene, nearer, before.shown, tile, nearer.sloped ? slope : one)) continue;
        any = true;
        if (nearer.sloped) {
            sloped = true;
        } else {
            hide(one);
        }
    }
    if (sloped) hide(slope);
    return any;
}

/// The picture itself over 2 x 2 and 4 x 4 pixels, once, for the looks that ask for it.
void averagePicture(EngineScene& scene, int threads) {
    std::array<bool, 2> asked{};
    for (const EngineLight& light : scene.lights) {
        for (const EngineLook& look : light.looks) {
            if (look.takesPart && look.shown.placing.coarse != 1) asked[averagedAt(look.shown.placing.coarse)] = true;
        }
    }
    for (std::size_t which = 0; which < 2; ++which) {
        auto& planes = scene.averagedAlbedo[which];
        if (!asked[which] || !planes[0].empty()) continue;
        const int coarse = kCoarse[which];
        planes.fill(averagedPlane(scene.tiles, coarse));
        shareOut(scene.tiles.count(), threads, [&](int tile) {
            const ViewRect rect = scene.tiles.rect(tile);
            const Covered covered{rect.grown(averagingLead(coarse)), nullptr, 0, 1.0F};
            for (std::size_t c = 0; c < 3; ++c)
                averageInto(planes[c], coarse, rect, covered, &scene.albedo[c]);
        });
    }
}

}  // namespace

Source coverageOf(Workspace& work, const EngineSurface& surface, const Shown& shown, ViewRect part) {
    const int coarse = shown.placing.coarse;
    if (coarse != 1) return {{}, &surface.averaged[averagedAt(coarse)]};
    const std::array<const TilePlane*, 1> alpha{&surface.alpha};
    return {maskOver(work, part.grown(shown.reach), alpha), nullptr};
}

void updateVisibility(EngineScene& scene, bool all, int threads) {
    if (all) makeRoomForAverages(scene);
    updateAveragedAlpha(scene, all, threads);

    std::vector<Job> visible, passing;
    for (std::size_t l = 0; l < scene.lights.size(); ++l) {
        for (std::size_t k = 0; k < scene.surfaces.size(); ++k) {
            EngineLook& look = scene.lights[l].looks[k];
            look.changedVisible.clear();
            look.changedPassing.clear();
            if (!look.visible.empty()) {
                Marks marks(scene.tiles);
                if (all) marks.markAll();
                for (const Before& before : look.visibleBehind) {
                    for (const ViewRect& rect : scene.surfaces[static_cast<std::size_t>(before.nearer)].changed)
                        marks.mark(before.shown.reached(rect));
                }
                marks.each([&](int tile) { visible.push_back({l, k, tile}); });
            }
            if (look.hides) {
                Marks marks(scene.tiles);
                if (all) marks.markAll();
                for (const ViewRect& rect : scene.surfaces[k].changed)
                    marks.mark(look.shown.reached(rect));
                marks.each([&](int tile) { passing.push_back({l, k, tile}); });
            }
        }
    }
    std::vector<ViewRect> changed(visible.size() + passing.size());
    shareOut(static_cast<int>(changed.size()), threads, [&](int i) {
        const auto n = static_cast<std::size_t>(i);
        const bool first = n < visible.size();
        const Job& job = first ? visible[n] : passing[n - visible.size()];
        EngineLook& look = scene.lights[job.light].looks[job.surface];
        std::array<float, kTilePixels> shares;
        shares.fill(1.0F);
        const bool any = first ? leaveVisible(scene, look, job.tile, shares)
                               : takeAway(scene, scene.surfaces[job.surface], look.shown, job.tile, shares);
        TilePlane& plane = first ? look.visible : look.passing;
        if (any) {
            settle(shares.data(), kRounding);
            changed[n] = plane.set(job.tile, shares.data());
        } else {
            changed[n] = plane.fill(job.tile, 1.0F);
        }
    });
    for (std::size_t n = 0; n < changed.size(); ++n) {
        if (changed[n].empty()) continue;
        const bool first = n < visible.size();
        const Job& job = first ? visible[n] : passing[n - visible.size()];
        EngineLook& look = scene.lights[job.light].looks[job.surface];
        (first ? look.changedVisible : look.changedPassing).push_back(changed[n]);
    }
}

void updateAveraged(EngineScene& scene, bool all, int threads) {
    averagePicture(scene, threads);
    std::vector<Job> jobs;
    for (std::size_t l = 0; l < scene.lights.size(); ++l) {
        EngineLight& light = scene.lights[l];
        for (std::size_t k = 0; k < scene.surfaces.size(); ++k) {
            EngineLook& look = light.looks[k];
            const int coarse = look.shown.placing.coarse;
            if (coarse == 1 || !look.takesPart) continue;
            const bool fresh = look.averaged[0].empty();
            auto& spare = scene.spareAverages[averagedAt(coarse)];
            if (fresh && !spare.empty()) {
                look.averaged = std::move(spare.back().averaged);
                look.averagedDark = std::move(spare.back().dark);
                spare.pop_back();
            } else if (fresh) {
                for (PaddedPlane& plane : look.averaged)
                    plane = averagedPlane(scene.tiles, coarse);
                look.averagedDark.assign(static_cast<std::size_t>(scene.tiles.count()), 1);
            }
            Marks marks(scene.tiles);
            if (all || fresh) marks.markAll();
            const auto mark = [&](const std::vector<ViewRect>& rects) {
                for (const ViewRect& rect : rects)
                    marks.mark(rect.grown(averagingLead(coarse)));
            };
            mark(scene.surfaces[k].changed);
            mark(look.changedVisible);
            if (light.light.level != Exposure::kAmbient)
                mark(scene.changedLight[static_cast<std::size_t>(light.light.level)]);
            const auto planes = scene.planesOf(light, k);
            marks.each([&](int tile) {
                const bool dark = litBox(scene.tiles.rect(tile).grown(averagingLead(coarse)), planes).empty();
                if (!dark || look.averagedDark[static_cast<std::size_t>(tile)] == 0) jobs.push_back({l, k, tile});
            });
        }
    }
    shareOut(static_cast<int>(jobs.size()), threads, [&](int i) {
        const Job& job = jobs[static_cast<std::size_t>(i)];
        EngineLight& light = scene.lights[job.light];
        EngineLook& look = light.looks[job.surface];
        const int coarse = look.shown.placing.coarse;
        const auto planes = scene.planesOf(light, job.surface);
        const ViewRect rect = scene.tiles.rect(job.tile), window = rect.grown(averagingLead(coarse));
        const bool dark = litBox(window, planes).empty();
        look.averagedDark[static_cast<std::size_t>(job.tile)] = dark ? 1 : 0;
        const Covered covered = dark ? Covered{} : coveredOver(workspace(), window, planes);
        for (std::size_t c = 0; c < 3; ++c) {
            if (dark) {
                fill(look.averaged[c], coarse, rect, 0.0F);
            } else if (!covered.mask && covered.even == 1.0F) {  // the picture's own average, to the bit
                copyTile(look.averaged[c], scene.averagedAlbedo[averagedAt(coarse)][c], coarse, rect);
            } else {
                if (c + 1 < 3) fetchAhead(scene.albedo[c + 1], window);
                averageInto(look.averaged[c], coarse, rect, covered, &scene.albedo[c]);
            }
        }
    });
}

}  // namespace ilf::view
