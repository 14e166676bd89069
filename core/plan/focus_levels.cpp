#include "core/plan/focus_levels.h"

#include <algorithm>
#include <numeric>

namespace ilf {

FocusWindow focusWindow(const PlanInput& input, const PlanObject& object) {
    const PowerWindow nearest = inFocusWindow(input.eye, object.nearest);
    const PowerWindow farthest = inFocusWindow(input.eye, object.farthest);
    const Dioptre middle = 0.5 * (1.0 / object.nearest + 1.0 / object.farthest);
    return {std::max(nearest.low, input.rig.lensMin), std::min(farthest.high, input.rig.lensMax),
            middle + restPower(input.eye)};
}

FocusLevels focusLevels(const std::vector<FocusWindow>& windows, Dioptre preferred, bool camera) {
    std::vector<std::size_t> order(windows.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return windows[i].high; });

    FocusLevels levels;
    levels.ofWindow.resize(windows.size());
    for (std::size_t first = 0; first < order.size();) {
        const Dioptre stab = windows[order[first]].high;
        Dioptre low = windows[order[first]].low, lowestCentre = windows[order[first]].centre;
        Dioptre highestCentre = lowestCentre;
        std::size_t last = first;
        for (; last < order.size() && windows[order[last]].low <= stab; ++last) {
            const FocusWindow& window = windows[order[last]];
            low = std::max(low, window.low);
            lowestCentre = std::min(lowestCentre, window.centre);
            highestCentre = std::max(highestCentre, window.centre);
            levels.ofWindow[order[last]] = levels.powers.size();
        }
        const Dioptre wanted = camera ? 0.5 * (lowestCentre + highestCentre) : preferred;
        levels.powers.push_back(std::clamp(wanted, low, stab));
        first = last;
    }
    return levels;
}

}  // namespace ilf
