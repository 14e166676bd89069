#include "core/perceived/seam_words.h"

#include <cstdio>

namespace ilf {
namespace {

std::string percent(double share) {
    char text[32];
    std::snprintf(text, sizeof text, share < 0.0995 ? "%.1f %%" : "%.0f %%", 100.0 * share);
    return text;
}

std::string millimetres(Metre length) {
    char text[32];
    std::snprintf(text, sizeof text, length < 9.95_mm ? "%.1f mm" : "%.0f mm", length.in(1.0_mm));
    return text;
}

}  // namespace

std::string saidOf(const BorderSeam& seam, const Seam& settings) {
    if (seam.depthStep)
        return "One surface stands before the other here, so nothing is blended: its outline shows, with " +
               percent(seam.worst()) + " of contrast.";
    std::string words;
    if (seam.apart > 0.05_mm) {
        words = "The two eyes see this border " + millimetres(seam.apart) +
                " apart; the blend lies in the middle and leaves " + percent(seam.now[0].weber) + " to the left eye, " +
                percent(seam.now[1].weber) + " to the right.";
    } else {
        words = "Both eyes see this border in one place; blending leaves " + percent(seam.worst()) + ".";
    }
    const HidingWidth& hiding = seam.hiding;
    if (hiding.clamped) {
        words += " " + millimetres(hiding.asked) +
                 " of feather would hide it, more than the region has room for: " + millimetres(hiding.width) +
                 " leaves about " + percent(hiding.left) + ".";
    } else if (settings.feather < hiding.width) {
        words += " A feather of " + millimetres(hiding.width) + " hides it.";
    }
    return words;
}

}  // namespace ilf
