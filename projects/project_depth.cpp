#include "projects/project_depth.h"

#include <utility>

#include "projects/depth_file.h"
#include "projects/depth_formats.h"
#include "projects/pictures.h"

namespace ilf::projects {

Result<EncodedDepth> encodedDepth(const DepthMap& depth, const EncodedDepth& known) {
    const bool same = known.bytes && known.depth.metres.same(depth.metres) && known.depth.sigma.same(depth.sigma) &&
                      known.depth.step == depth.step;
    if (same) return known;
    const Image<std::uint16_t> raw = depth.sigma.empty() ? wholeSteps(depth) : Image<std::uint16_t>();
    auto bytes = raw.empty() ? encodeDepthExr(depth.metres, depth.sigma) : encodePng16(raw);
    if (!bytes) return tl::unexpected(bytes.error());
    return EncodedDepth{depth, Box<std::string>(*std::move(bytes)), raw.empty() ? ".exr" : ".png"};
}

Result<DepthMap> decodedDepth(std::string_view bytes, const std::string& name, Metre step) {
    if (looksLikeExr(bytes)) {
        return decodeDepthExr(bytes, name).map([&](DepthPixels pixels) {
            return DepthMap{std::move(pixels.metres), std::move(pixels.sigma), step};
        });
    }
    if (!(step > 0.0_m)) return fail(Fault::badFile, name + " is a depth map of steps whose length is not said.");
    return decodeDepth16(bytes, name).map([&](const Image<std::uint16_t>& raw) { return depthOf(raw, step); });
}

}  // namespace ilf::projects
