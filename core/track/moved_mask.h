// A painted mask where its thing is now, and a document in which what follows has moved.
#pragma once

#include <span>

#include "core/document/document.h"
#include "core/track/quad.h"

namespace ilf {

/// Nothing is worked out anew for less.
inline constexpr double kLeastMotion_px = 0.05;

/// The mask moved, bilinear, averaged over each pixel's area where it shrinks. Tiles that neither the mask nor its new
/// place touches are shared, uniform ones are not computed, and where `before` (the last answer, if any) has equal
/// tiles its own are given, so that what compares boxes sees only what changed. The mask itself when no corner of what
/// it covers moves by kLeastMotion_px.
Mask moved(const Mask& mask, const Motion& motion, const Mask* before = nullptr);

/// What a region's follower says (core/track/follower.h).
struct RegionMotion {
    RegionId region;
    Motion motion;
    double fade = 0.0;  ///< 0: its own look, 1: that of its `whenLost`
    bool operator==(const RegionMotion&) const = default;
};

/// The document as it is now: masks, outlines and the anchors of planes move along; a depth map does not, as it
/// belongs to the picture. A region that fades is on its way (LookFade) to the look of its `whenLost` and has it at
/// last (a blurred one loses its strength: the safe blur is that of the sweep's end). Light goes over evenly; the plan
/// has both looks meanwhile, so the sweep may change as the fade begins and as it ends. Regions that follow nothing,
/// and motions of regions that are not there, are left alone. `before`: the last answer, whose tiles are shared.
Document moved(const Document& document, std::span<const RegionMotion> motions, const Document* before = nullptr);

/// Where a mask's middle is, by coverage; the picture's middle for a blank one.
Point<CameraFrame> middleOf(const Mask& mask);

}  // namespace ilf
