// The paper's seam experiment (section 5.5) on real textures: a page of text and a painting, before and after blending.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/base/image.h"
#include "core/base/result.h"
#include "core/document/document.h"

namespace ilf::app {

/// One texture, side and power; arrays run over Blending.
struct SeamExperimentCase {
    std::string texture;
    bool gap = false;  ///< the blurred side lies outside: dark without blending; else an overlap, bright
    double power_D = 0.0;
    std::array<double, 4> light{};     ///< worst Weber contrast of even light, exact along the border
    std::array<double, 4> weighted{};  ///< the same weighted by contrast sensitivity
    std::array<double, 4> measured{};  ///< from the pictures: means of columns against the plain view, signed
    Image<std::uint8_t> plain;
    std::array<Image<std::uint8_t>, 4> pictures;
};

/// `folder` holds opencv/imageTextN.png and wuffs/harvesters.jpeg. A camera with a pupil of 4 mm looks at a surface
/// half a metre away, the border 100 mm from the optical centre, feather 10 mm.
Result<std::vector<SeamExperimentCase>> seamExperiment(const std::string& folder);

/// Writes every picture, one sheet a texture (rows: the four blendings; columns: gap 1 D, gap 2 D, overlap 1 D, overlap
/// 2 D; 40 mm around the border each) and seams.csv; gives the table as text.
Result<std::string> writeSeamExperiment(const std::string& folder, const std::vector<SeamExperimentCase>& cases);

}  // namespace ilf::app
