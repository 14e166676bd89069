// What a scan measured: its figures and picture for the registering page, and its metres set right by a tape measure.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/document/viewer_pose.h"
#include "ui/register_view.h"

namespace ilf::app {

/// `decoded`: pixels that could have a depth.
ui::RegisterDepth figuresOf(const MeasuredDepth& depth, int decoded);
/// RGB: yellow near, violet far, grey without a depth.
Image<std::uint8_t> depthPicture(const MeasuredDepth& depth);
/// RGB: how well each depth is known; violet well, yellow badly.
Image<std::uint8_t> spreadPicture(const MeasuredDepth& depth);
/// Their colours, from the least figure that `figuresOf` tells to the greatest; `nearIsBright`: of the depth picture.
std::vector<std::array<std::uint8_t, 3>> depthRamp(bool nearIsBright);
/// Straight through the room between what is seen at two places of the picture; none: there is no depth at one of them.
std::optional<Metre> lengthBetween(const MeasuredDepth& depth, Point<CameraFrame> from, Point<CameraFrame> to);
/// All lengths, and what is known of them, `factor` times as long.
MeasuredDepth scaled(const MeasuredDepth& depth, double factor);

}  // namespace ilf::app
