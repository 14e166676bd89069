#include "core/perceived/seam_border.h"

#include <atomic>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "core/base/parallel.h"
#include "core/perceived/seam_light.h"
#include "core/perceived/seam_patch.h"
#include "core/perceived/seam_weighting.h"
#include "core/perceived/seam_words.h"

namespace ilf {
namespace {

using view::Block;
using view::Crossing;
using view::Displacement;
using view::Light;
using view::LitRegions;
using view::PatchWindow;
using view::WholeBorder;

/// Profiles are at most this many patch pixels to each side; longer ones are worked out on coarser pixels.
constexpr double kMostReach = 40.0;
constexpr Eye kEyes[] = {Eye::left, Eye::right};
/// Profiles worked out in one cell.
constexpr std::size_t kLines = 6;

struct Line {
    Point<CameraFrame> at;
    double nx = 1.0, ny = 0.0;
};

/// One border and what all its patches share.
struct Border {
    std::size_t blurred = 0, other = 0;
    Dioptre power;
    double reach = 0.0, pitch = 1.0;  ///< picture pixels
    std::optional<SeamWeighting> weighting;
    std::size_t crossings = 0;
    int cells = 0;
};

/// A part of a border small enough for one patch, and what was found there.
struct Cell {
    std::size_t border = 0;
    std::vector<Line> lines;
    Metre distance;
    Displacement displaced;
    bool depthStep = false;
    double length_m = 0.0;
    std::vector<bool> kin{};  ///< regions lit like one of the border's two, as far away

    std::vector<std::array<double, 2>> weber{};  ///< as compiled, of each line
    std::array<BothEyes, 4> blendings{};
};

void keepWorst(SeamContrast& worst, const SeamContrast& one) {
    const double weighted = std::max(worst.weighted, one.weighted);
    if (one.weber > worst.weber) worst = one;
    worst.weighted = weighted;
}

class Search {
public:
    Search(const Compiled& compiled, const SeamQuestion& question, const std::function<bool()>& cancelled)
        : compiled_(compiled), question_(question), cancelled_(cancelled), regions_(compiled) {}

    std::vector<BorderSeam> run() {
        findCells();
        compileOthers();
        parallelFor(static_cast<int>(cells_.size()), [&](int i) {
            if (!stopped()) lookAt(cells_[static_cast<std::size_t>(i)]);
        });
        std::vector<BorderSeam> seams(borders_.size());
        for (std::size_t b = 0; b < borders_.size(); ++b)
            seams[b] = summed(b);
        if (question_.underErrors) {
            parallelFor(static_cast<int>(borders_.size()), [&](int b) {
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

    Line lineAt(const Crossing& crossing) const {
        const auto [nx, ny] = view::normalAt(regions_, crossing);
        return {crossing.at(), nx, ny};
    }

    std::optional<Metre> distanceOf(std::size_t region, Point<CameraFrame> at) const {
        return distanceAt(compiled_.document, *regions_.all()[region].region, at);
    }

    void findCells() {
        std::size_t all = 0;
        for (const WholeBorder& whole : view::wholeBorders(regions_)) {
            if (stopped()) return;
            Border border{whole.blurred, whole.other, *regions_.all()[whole.blurred].displaced, 0.0, 1.0, {}, 0, 0};
            border.crossings = whole.crossings.size();
            // The same reach along a border: of where it is largest among a few places.
            for (std::size_t i = 0; i < whole.crossings.size(); i += 1 + whole.crossings.size() / 16) {
                const Line line = lineAt(whole.crossings[i]);
                const auto distance = distanceOf(whole.blurred, line.at);
                if (!distance) continue;
                const auto displaced =
                    view::displacementAt(compiled_, line.at, line.nx, line.ny, *distance, border.power);
                border.reach = std::max(border.reach, displaced.reach(compiled_.document.seam));
            }
            if (border.reach == 0.0) continue;
            border.pitch = std::max(1.0, border.reach / kMostReach);
            const double step_deg = border.pitch / compiled_.document.scene.scale.focalPixels * 57.29577951;
            border.weighting.emplace(step_deg, 2 * samples(border) + 1);
            borders_.push_back(std::move(border));
            all += addCells(whole);
        }
        thinOut(all);
    }

    static int samples(const Border& border) { return static_cast<int>(std::ceil(border.reach / border.pitch)); }

    /// Squares about as wide as the seam reaches.
    std::size_t addCells(const WholeBorder& whole) {
        Border& border = borders_.back();
        const int side = std::max(16, static_cast<int>(border.reach));
        std::map<std::pair<int, int>, std::vector<Crossing>> squares;
        for (const Crossing& crossing : whole.crossings)
            squares[{crossing.y / side, crossing.x / side}].push_back(crossing);
        for (const auto& [square, crossings] : squares) {
            const Crossing& middle = crossings[crossings.size() / 2];
            const Line line = lineAt(middle);
            const auto distance = distanceOf(whole.blurred, line.at);
            if (!distance) continue;
            Cell cell;
            cell.border = borders_.size() - 1;
            cell.distance = *distance;
            cell.displaced = view::displacementAt(compiled_, line.at, line.nx, line.ny, *distance, border.power);
            const auto behind = distanceOf(whole.other, line.at);
            cell.depthStep = behind && abs(1.0 / *behind - 1.0 / *distance) > kDepthStep;
            for (std::size_t r = 0; r < regions_.all().size(); ++r) {
                const auto d = distanceOf(r, line.at);
                const auto like = [&](std::size_t one, std::optional<Metre> at) {
                    return r == one || (regions_.all()[r].level == regions_.all()[one].level && d && at &&
                                        abs(1.0 / *d - 1.0 / *at) < 1e-3_D);
                };
                cell.kin.push_back(like(whole.blurred, distance) || like(whole.other, behind));
            }
            // Pixel edges along a slanted line are longer than it, by 4 / pi on average.
            cell.length_m = static_cast<double>(crossings.size()) * 0.785 / cell.displaced.pixelsPerMetre;
            const std::size_t count = std::min(kLines, crossings.size());
            for (std::size_t i = 0; i < count; ++i)
                cell.lines.push_back(lineAt(crossings[(2 * i + 1) * crossings.size() / (2 * count)]));
            cells_.push_back(std::move(cell));
            ++border.cells;
        }
        return squares.size();
    }

    /// Every n-th cell of a border, so that a scene with long borders takes no longer than one with short ones.
    void thinOut(std::size_t all) {
        const auto most = static_cast<std::size_t>(std::max(1, question_.mostPatches));
        if (all <= most) return;
        const std::size_t step = (all + most - 1) / most;
        std::vector<Cell> kept;
        std::vector<std::size_t> seen(borders_.size());
        for (Cell& cell : cells_) {
            if (seen[cell.border]++ % step == 0) kept.push_back(std::move(cell));
        }
        cells_ = std::move(kept);
    }

    void compileOthers() {
        const auto own = static_cast<std::size_t>(compiled_.document.seam.blending);
        for (std::size_t b = 0; b < programs_.size() && question_.allBlendings && !cells_.empty(); ++b) {
            if (b == own || stopped()) continue;
            Document document = compiled_.document;
            document.seam.blending = static_cast<Blending>(b);
            auto made = compile(document, compiled_.plan);
            if (made) programs_[b] = *std::move(made);
        }
    }

    PatchWindow windowOf(const Cell& cell) const {
        double x0 = 1e9, y0 = 1e9, x1 = -1e9, y1 = -1e9;
        for (const Line& line : cell.lines) {
            x0 = std::min(x0, line.at.x);
            x1 = std::max(x1, line.at.x);
            y0 = std::min(y0, line.at.y);
            y1 = std::max(y1, line.at.y);
        }
        const Border& border = borders_[cell.border];
        const double halo = border.reach + cell.displaced.radius + cell.displaced.shift + 3.0 * border.pitch;
        return PatchWindow::around(x0, y0, x1, y1, std::min(halo, 4.0 * kMostReach * border.pitch), border.pitch);
    }

    /// Where the profile across a line lies: from the border to both sides until it leaves the picture, or comes to a
    /// surface or light that is neither of the border's two, less what shines over from there.
    std::vector<Point<CameraFrame>> profile(const Line& line, const Cell& cell) const {
        const Border& border = borders_[cell.border];
        const int reach = samples(border);
        const double margin = cell.displaced.radius + std::abs(cell.displaced.seam());
        const int blur = static_cast<int>(std::ceil(margin / border.pitch));
        const auto point = [&](int i) {
            return Point<CameraFrame>{line.at.x + i * border.pitch * line.nx, line.at.y + i * border.pitch * line.ny};
        };
        const auto last = [&](int side) {
            int i = 0;
            for (; i < reach; ++i) {
                const auto p = point(side * (i + 1));
                const int x = static_cast<int>(std::floor(p.x)), y = static_cast<int>(std::floor(p.y));
                if (!regions_.inside(x, y)) return i;
                if (!cell.kin[regions_.owner(x, y)]) return i - blur;
            }
            return i;
        };
        std::vector<Point<CameraFrame>> points;
        for (int i = -last(-1); i <= last(1); ++i)
            points.push_back(point(i));
        return points;
    }

    /// `light` gives what is received at a point.
    template <class Light>
    static SeamContrast contrast(const Line& line, const Border& border, const std::vector<Point<CameraFrame>>& points,
                                 Light&& light) {
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

    /// All the picture whose light reaches a cell's profiles, under errors too.
    PixelRect<CameraFrame> around(const Cell& cell) const {
        const PatchWindow window = windowOf(cell);
        const double more = 0.5 * cell.displaced.radius + 8.0;
        return {static_cast<int>(window.x0 - more), static_cast<int>(window.y0 - more),
                static_cast<int>(window.x0 + window.pitch * window.size.width + more) + 1,
                static_cast<int>(window.y0 + window.pitch * window.size.height + more) + 1};
    }

    void lookAt(Cell& cell) const {
        cell.weber.assign(cell.lines.size(), {});
        if (cell.depthStep) return lookPastStep(cell);
        const auto own = static_cast<std::size_t>(compiled_.document.seam.blending);
        const auto box = around(cell);
        for (std::size_t b = 0; b < programs_.size(); ++b) {
            if (b != own && !programs_[b]) continue;
            const view::SeamLight light(compiled_, b == own ? compiled_.program : programs_[b]->program, box);
            for (const std::size_t eye : {0U, 1U}) {
                const auto view = light.view({kEyes[eye], cell.distance, cell.distance, {}});
                for (std::size_t l = 0; l < cell.lines.size(); ++l) {
                    const auto one = contrast(cell.lines[l], borders_[cell.border], profile(cell.lines[l], cell),
                                              [&](Point<CameraFrame> p) { return light.at(p, view); });
                    keepWorst(cell.blendings[b][eye], one);
                    if (b == own) cell.weber[l][eye] = one.weber;
                }
            }
        }
    }

    /// Where one surface hides another, and nothing is blended whatever the blending.
    void lookPastStep(Cell& cell) const {
        const PatchWindow window = windowOf(cell);
        const auto surfaces = view::patchSurfaces(compiled_.document, regions_, cell.lines.front().at, window);
        const auto lights = view::programLights(compiled_, window);
        for (const std::size_t eye : {0U, 1U}) {
            const Block image =
                view::seenPatch(compiled_, window, surfaces, lights, {kEyes[eye], cell.distance, cell.distance, {}});
            for (std::size_t l = 0; l < cell.lines.size(); ++l) {
                const auto one = contrast(cell.lines[l], borders_[cell.border], profile(cell.lines[l], cell),
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
        const Border& border = borders_[b];
        BorderSeam seam;
        seam.blurred = regions_.all()[border.blurred].region->id;
        seam.other = regions_.all()[border.other].region->id;
        const auto own = static_cast<std::size_t>(compiled_.document.seam.blending);
        int cells = 0, steps = 0;
        Metre axes, blur;
        for (const Cell& cell : cells_) {
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
        seam.hiding = hidingWidth(0.5 * seam.apart, errorShift(b), blur, extentOf(b));
        seam.combined = {seam.now[0].weber, seam.now[1].weber};
        seam.says = saidOf(seam, compiled_.document.seam);
        return seam;
    }

    /// How far apart the counted errors bring the light of the two levels along the normal, where that is most.
    Metre errorShift(std::size_t b) const {
        const EyeOptics& eye = compiled_.plan.input.eye;
        Metre most;
        for (const Cell& cell : cells_) {
            if (cell.border != b) continue;
            const Displacement& d = cell.displaced;
            EyeOptics farther = eye;
            farther.lensToPupil += question_.errors.lensToPupil;
            const double stretch =
                magnification(farther, d.distance, compiled_.plan.focusPower, borders_[b].power) - 1.0;
            const double lens = d.stretch == 0.0 ? 0.0 : d.seam() * (stretch / d.stretch - 1.0) / d.pixelsPerMetre;
            const double gaze = d.stretch * question_.errors.gaze.si();
            most = std::max(most, Metre::fromSi(std::hypot(question_.errors.registration.si(), gaze, lens)));
        }
        return most;
    }

    /// How wide what is seen of the displaced region is, across the surface: the shorter side of its box, or less where
    /// its outline is long for its area.
    Metre extentOf(std::size_t b) const {
        const Border& border = borders_[b];
        double pixels = 0.0, metre = 1.0;
        int x0 = 1 << 30, y0 = 1 << 30, x1 = 0, y1 = 0;
        for (int y = 0; y < regions_.size().height; y += 4) {
            for (int x = 0; x < regions_.size().width; x += 4) {
                if (regions_.owner(x, y) != border.blurred) continue;
                pixels += 16.0;
                x0 = std::min(x0, x);
                x1 = std::max(x1, x + 4);
                y0 = std::min(y0, y);
                y1 = std::max(y1, y + 4);
            }
        }
        for (const Cell& cell : cells_) {
            if (cell.border == b) metre = cell.displaced.pixelsPerMetre;
        }
        const double outline = 0.785 * static_cast<double>(border.crossings);
        const double side = std::min(std::max(0, x1 - x0), std::max(0, y1 - y0));
        return Metre::fromSi(std::min(side, 4.0 * pixels / std::max(1.0, outline)) / metre);
    }

    /// The cells where errors are looked at: the worst ones for each eye now, and where light is displaced most along
    /// the normal.
    std::set<const Cell*> telling(std::size_t b) const {
        std::array<const Cell*, 4> best{};
        const auto own = static_cast<std::size_t>(compiled_.document.seam.blending);
        for (const Cell& cell : cells_) {
            if (cell.border != b || cell.depthStep) continue;
            for (const std::size_t eye : {0U, 1U}) {
                const Cell*& worst = best[eye];
                if (!worst || cell.blendings[own][eye].weber > worst->blendings[own][eye].weber) worst = &cell;
                const Cell*& moved = best[2 + eye];
                if (!moved || std::abs(cell.displaced.along[eye]) > std::abs(moved->displaced.along[eye]))
                    moved = &cell;
            }
        }
        std::set<const Cell*> cells(best.begin(), best.end());
        cells.erase(nullptr);
        return cells;
    }

    void lookUnderErrors(std::size_t b, BorderSeam& seam) {
        const Border& border = borders_[b];
        const EyeOptics& eye = compiled_.plan.input.eye;
        for (const Cell* cell : telling(b)) {
            const view::SeamLight light(compiled_, compiled_.program, around(*cell));
            std::vector<std::vector<Point<CameraFrame>>> profiles;
            for (const Line& line : cell->lines)
                profiles.push_back(profile(line, *cell));
            const Line& middle = cell->lines[cell->lines.size() / 2];
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
    LitRegions regions_;
    std::vector<Border> borders_;
    std::vector<Cell> cells_;
    std::array<std::optional<Compiled>, 4> programs_;
    std::atomic<bool> stopped_ = false;
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
