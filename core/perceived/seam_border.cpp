#include "core/perceived/seam_border.h"

#include <atomic>
#include <cmath>
#include <optional>
#include <set>

#include "core/base/parallel.h"
#include "core/perceived/seam_cells.h"
#include "core/perceived/seam_light.h"
#include "core/perceived/seam_words.h"

namespace ilf {
namespace {

using view::Block;
using view::Displacement;
using view::PatchWindow;
using view::SeamBorder;
using view::SeamCell;
using view::SeamCells;
using view::SeamLine;

constexpr Eye kEyes[] = {Eye::left, Eye::right};

void keepWorst(SeamContrast& worst, const SeamContrast& one) {
    const double weighted = std::max(worst.weighted, one.weighted);
    if (one.weber > worst.weber) worst = one;
    worst.weighted = weighted;
}

class Search {
public:
    Search(const Compiled& compiled, const SeamQuestion& question, const std::function<bool()>& cancelled)
        : compiled_(compiled), question_(question), cancelled_(cancelled),
          at_(compiled, question.mostPatches, [this] { return stopped(); }) {}

    std::vector<BorderSeam> run() {
        compileOthers();
        parallelFor(static_cast<int>(at_.cells.size()), [&](int i) {
            if (!stopped()) lookAt(at_.cells[static_cast<std::size_t>(i)]);
        });
        std::vector<BorderSeam> seams(at_.borders.size());
        for (std::size_t b = 0; b < at_.borders.size(); ++b)
            seams[b] = summed(b);
        if (question_.underErrors) {
            parallelFor(static_cast<int>(at_.borders.size()), [&](int b) {
                if (!stopped()) lookUnderErrors(static_cast<std::size_t>(b), seams[static_cast<std::size_t>(b)]);
            });
        }
        if (stopped()) return {};
        std::ranges::stable_sort(seams, std::ranges::greater{}, &BorderSeam::worst);
        return seams;
    }

private:
    bool stopped() {
        if (!stopped_ && cancelled_ && cancelled_()) stopped_ = true;
        return stopped_;
    }

    void compileOthers() {
        const auto own = static_cast<std::size_t>(compiled_.document.seam.blending);
        for (std::size_t b = 0; b < programs_.size() && question_.allBlendings && !at_.cells.empty(); ++b) {
            if (b == own || stopped()) continue;
            Document document = compiled_.document;
            document.seam.blending = static_cast<Blending>(b);
            auto made = compile(document, compiled_.plan);
            if (made) programs_[b] = *std::move(made);
        }
    }

    /// `light` gives what is received at a point.
    template <class Light>
    static SeamContrast contrast(const SeamLine& line, const SeamBorder& border,
                                 const std::vector<Point<CameraFrame>>& points, Light&& light) {
        std::vector<double> differences;
        SeamContrast found{0.0, 0.0, line.at, false};
        for (const auto& p : points) {
            differences.push_back(light(p) - 1.0);
            if (std::abs(differences.back()) <= found.weber) continue;
            found.weber = std::abs(differences.back());
            found.gap = differences.back() < 0.0;
        }
        found.weighted = border.weighting->worst(differences);
        return found;
    }

    void lookAt(SeamCell& cell) const {
        cell.weber.assign(cell.lines.size(), {});
        if (cell.depthStep) return lookPastStep(cell);
        const auto own = static_cast<std::size_t>(compiled_.document.seam.blending);
        const auto box = at_.around(cell);
        for (std::size_t b = 0; b < programs_.size(); ++b) {
            if (b != own && !programs_[b]) continue;
            const view::SeamLight light(compiled_, b == own ? compiled_.program : programs_[b]->program, box);
            for (const std::size_t eye : {0U, 1U}) {
                const auto view = light.view({kEyes[eye], cell.distance, cell.distance, {}});
                for (std::size_t l = 0; l < cell.lines.size(); ++l) {
                    const auto one = contrast(cell.lines[l], at_.borders[cell.border], at_.profile(cell.lines[l], cell),
                                              [&](Point<CameraFrame> p) { return light.at(p, view); });
                    keepWorst(cell.blendings[b][eye], one);
                    if (b == own) cell.weber[l][eye] = one.weber;
                }
            }
        }
    }

    /// Where one surface hides another, and nothing is blended whatever the blending.
    void lookPastStep(SeamCell& cell) const {
        const PatchWindow window = at_.windowOf(cell);
        const auto surfaces = view::patchSurfaces(compiled_.document, at_.regions(), cell.lines.front().at, window);
        const auto lights = view::programLights(compiled_, window);
        for (const std::size_t eye : {0U, 1U}) {
            const Block image =
                view::seenPatch(compiled_, window, surfaces, lights, {kEyes[eye], cell.distance, cell.distance, {}});
            for (std::size_t l = 0; l < cell.lines.size(); ++l) {
                const auto one = contrast(cell.lines[l], at_.borders[cell.border], at_.profile(cell.lines[l], cell),
                                          [&](Point<CameraFrame> p) {
                                              const auto q = window.toPatch(p);
                                              return static_cast<double>(view::sampled(image, q.x, q.y));
                                          });
                for (BothEyes& blending : cell.blendings)
                    keepWorst(blending[eye], one);
                cell.weber[l][eye] = one.weber;
            }
        }
    }

    BorderSeam summed(std::size_t b) const {
        const SeamBorder& border = at_.borders[b];
        BorderSeam seam;
        seam.blurred = at_.regions().all()[border.blurred].region->id;
        seam.other = at_.regions().all()[border.other].region->id;
        const auto own = static_cast<std::size_t>(compiled_.document.seam.blending);
        int cells = 0, steps = 0;
        Metre axes, blur;
        for (const SeamCell& cell : at_.cells) {
            if (cell.border != b) continue;
            ++cells;
            steps += cell.depthStep ? 1 : 0;
            seam.length += Metre::fromSi(cell.length_m);
            seam.profiles += static_cast<int>(cell.lines.size());
            for (std::size_t l = 0; l < cell.weber.size(); ++l)
                seam.points.push_back({cell.lines[l].at, cell.weber[l]});
            for (std::size_t k = 0; k < cell.blendings.size(); ++k) {
                for (const std::size_t eye : {0U, 1U})
                    keepWorst(seam.blendings[k][eye], cell.blendings[k][eye]);
            }
            const Displacement& d = cell.displaced;
            seam.apart = std::max(seam.apart, Metre::fromSi(std::abs(d.along[0] - d.along[1]) / d.pixelsPerMetre));
            blur = std::max(blur, Metre::fromSi(d.radius / d.pixelsPerMetre));
        }
        seam.now = seam.blendings[own];
        seam.depthStep = 2 * steps > cells;
        seam.sampled = border.cells > 0 ? static_cast<double>(cells) / border.cells : 0.0;
        // The blend is made for the middle between the two eyes.
        seam.hiding = hidingWidth(0.5 * seam.apart, errorShift(b), blur, at_.extentOf(b));
        seam.combined = {seam.now[0].weber, seam.now[1].weber};
        seam.says = saidOf(seam, compiled_.document.seam);
        return seam;
    }

    /// How far apart the counted errors bring the light of the two levels along the normal, where that is most.
    Metre errorShift(std::size_t b) const {
        const EyeOptics& eye = compiled_.plan.input.eye;
        Metre most;
        for (const SeamCell& cell : at_.cells) {
            if (cell.border != b) continue;
            const Displacement& d = cell.displaced;
            EyeOptics farther = eye;
            farther.lensToPupil += question_.errors.lensToPupil;
            const double stretch =
                magnification(farther, d.distance, compiled_.plan.focusPower, at_.borders[b].power) - 1.0;
            const double lens = d.stretch == 0.0 ? 0.0 : d.seam() * (stretch / d.stretch - 1.0) / d.pixelsPerMetre;
            const double gaze = d.stretch * question_.errors.gaze.si();
            most = std::max(most, Metre::fromSi(std::hypot(question_.errors.registration.si(), gaze, lens)));
        }
        return most;
    }

    /// The cells where errors are looked at: the worst ones for each eye now, and where light is displaced most along
    /// the normal.
    std::set<const SeamCell*> telling(std::size_t b) const {
        std::array<const SeamCell*, 4> best{};
        const auto own = static_cast<std::size_t>(compiled_.document.seam.blending);
        for (const SeamCell& cell : at_.cells) {
            if (cell.border != b || cell.depthStep) continue;
            for (const std::size_t eye : {0U, 1U}) {
                const SeamCell*& worst = best[eye];
                if (!worst || cell.blendings[own][eye].weber > worst->blendings[own][eye].weber) worst = &cell;
                const SeamCell*& moved = best[2 + eye];
                if (!moved || std::abs(cell.displaced.along[eye]) > std::abs(moved->displaced.along[eye]))
                    moved = &cell;
            }
        }
        std::set<const SeamCell*> cells(best.begin(), best.end());
        cells.erase(nullptr);
        return cells;
    }

    void lookUnderErrors(std::size_t b, BorderSeam& seam) {
        const SeamBorder& border = at_.borders[b];
        const EyeOptics& eye = compiled_.plan.input.eye;
        for (const SeamCell* cell : telling(b)) {
            const view::SeamLight light(compiled_, compiled_.program, at_.around(*cell));
            std::vector<std::vector<Point<CameraFrame>>> profiles;
            for (const SeamLine& line : cell->lines)
                profiles.push_back(at_.profile(line, *cell));
            const SeamLine& middle = cell->lines[cell->lines.size() / 2];
            const auto cases = errorCases(question_.errors, eye, cell->distance, middle.nx, middle.ny);
            if (seam.errors.empty()) {
                for (const SeamErrorCase& one : cases)
                    seam.errors.push_back({one.kind, one.what, {}, one.counts});
            }
            for (std::size_t e = 0; e < cases.size(); ++e) {
                for (const Misplaced& off : cases[e].eyes) {
                    for (const std::size_t i : {0U, 1U}) {
                        if (stopped()) return;
                        const auto view = light.view({kEyes[i], cell->distance, cell->distance, off});
                        for (std::size_t l = 0; l < cell->lines.size(); ++l) {
                            keepWorst(seam.errors[e].eyes[i],
                                      contrast(cell->lines[l], border, profiles[l],
                                               [&](Point<CameraFrame> p) { return light.at(p, view); }));
                        }
                    }
                }
            }
        }
        for (const std::size_t i : {0U, 1U}) {
            double squares = 0.0;
            for (const SeamUnderError& error : seam.errors) {
                const double more = std::max(0.0, error.eyes[i].weber - seam.now[i].weber);
                if (error.counts) squares += more * more;
            }
            seam.combined[i] = seam.now[i].weber + std::sqrt(squares);
        }
        seam.says = saidOf(seam, compiled_.document.seam);
    }

    const Compiled& compiled_;
    const SeamQuestion& question_;
    const std::function<bool()>& cancelled_;
    std::atomic<bool> stopped_ = false;
    SeamCells at_;
    std::array<std::optional<Compiled>, 4> programs_;
};

}  // namespace

SeamSight sight(double weber) {
    return weber < kFaintSeam ? SeamSight::hidden : weber < kVisibleSeam ? SeamSight::faint : SeamSight::visible;
}

std::vector<BorderSeam> borderSeams(const Compiled& compiled, const SeamQuestion& question,
                                    const std::function<bool()>& cancelled) {
    const Plan& plan = compiled.plan;
    if (!compiled.document.scene.picture || !plan.sweeps() ||
        compiled.program.imageOfSlot.size() != plan.slots.size()) {
        return {};
    }
    return Search(compiled, question, cancelled).run();
}

}  // namespace ilf
