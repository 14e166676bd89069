// Finding the border of a blurred region nearest to the cursor.
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
};

/// The regions of a document, topmost first, the background last. Valid while the `compiled` it was made from lives.
class LitRegions {
public:
    explicit LitRegions(const Compiled& compiled);

    const std::vector<Lit>& all() const { return all_; }
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

/// Two pixels side by side: one blurred, one lit at another level.
struct Crossing {
    std::size_t blurred = 0, other = 0;  ///< indices into all()
    int x = 0, y = 0;                    ///< the blurred pixel
    int dx = 0, dy = 0;                  ///< towards the other
};

/// Nothing within `within` pixels of the cursor: nothing.
std::optional<Crossing> nearestCrossing(const LitRegions& regions, Point<CameraFrame> cursor, double within);

/// Unit normal of the border, from the blurred side outwards: against the slope of its share around the crossing.
std::pair<double, double> normalAt(const LitRegions& regions, const Crossing& crossing);

}  // namespace ilf::view
