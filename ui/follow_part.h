// What a region follows, and what it does when that is lost.
#pragma once

#include "ui/panel.h"

namespace ilf::ui {

void followPart(Panel& p, const Region& region);

/// How it stands with a region that follows something, in words, and how urgent that is.
struct FollowWords {
    std::string words;
    Tone tone = Tone::note;
    std::string help;  ///< what would help; may be empty
};
FollowWords followWords(const FollowView& view, const Region& region);
/// What happens when its target is lost: one sentence.
std::string lossWords(const Region& region);

}  // namespace ilf::ui
