// Finding borders between light that is displaced and light that is not: all of them, or the nearest to the cursor.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "core/compile/compile.h"

namespace ilf::view {

/// A region and how the plan lights it.
struct Lit {
    const Region* region;
    std::optional<int> level;
    bool blurred = false;
    /// The power at which its light is displaced most: its level's where it is blurred; where it is neutral, so lit in
    /// all lit slots, the strongest blur level's. None: its light stays where it is.
    std::optional<Dioptre> displaced;
};

/// The regions of a document, topmost first, the background last. Valid while the `compiled` it was made from lives.
class LitRegions {
public:
    explicit LitRegions(const Compiled& compiled);

    const std::vector<Lit>& all() const { return all_; }
    Size size() const { return size_; }
    bool inside(int x, int y) const { return x >= 0 && y >= 0 && x < size_.width && y < size_.height; }
    /// The topmost that covers at least half of a pixel: an index into all().
    std::size_t owner(int x, int y) const;
    /// What each shows of a pixel, as layers do; `shares` has the length of all().
    void shares(int x, int y, std::vector<float>& shares) const;

private:
    void add(const Plan& plan, const Region* region);
    Size size_;
    std::vector<Lit> all_;
};

/// Two pixels side by side, lit at different levels, the light of one displaced at least as much as the other's.
struct Crossing {
    std::size_t blurred = 0, other = 0;  ///< indices into all()
    int x = 0, y = 0;                    ///< the displaced pixel
    int dx = 0, dy = 0;                  ///< towards the other

    Point<CameraFrame> at() const { return {x + 0.5 + 0.5 * dx, y + 0.5 + 0.5 * dy}; }
};

/// All crossings between two regions; each pair of regions once.
struct WholeBorder {
    std::size_t blurred = 0, other = 0;
    std::vector<Crossing> crossings;  ///< row by row
};
std::vector<WholeBorder> wholeBorders(const LitRegions& regions);

/// Nothing within `within` pixels of the cursor: nothing.
std::optional<Crossing> nearestCrossing(const LitRegions& regions, Point<CameraFrame> cursor, double within);

/// Unit normal of the border, from the displaced side outwards: against the slope of its share around the crossing.
std::pair<double, double> normalAt(const LitRegions& regions, const Crossing& crossing);

}  // namespace ilf::view
