// Results of the reference, kept on disk: hours of rays are traced once.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "core/perceived/reference.h"

namespace ilf::app {

/// One file for each result, named by Reference::key and closed by a checksum. A file that is missing, damaged or of
/// another version is traced again; a folder that cannot be written to costs time, nothing else. The results least
/// recently used go when the folder grows beyond `mostBytes`.
class ReferenceCache {
public:
    /// In the user's cache folder.
    ReferenceCache();
    explicit ReferenceCache(std::filesystem::path folder, std::uintmax_t mostBytes = kMostBytes);

    /// As Reference::picture and Reference::pixels, and with the same refusals.
    Result<ReferencePicture> picture(const Reference& reference, const ReferenceRays& rays) const;
    Result<ReferencePixels> pixels(const Reference& reference, std::span<const ViewPixel> pixels,
                                   const ReferenceRays& rays) const;

private:
    static constexpr std::uintmax_t kMostBytes = 512U << 20U;
    std::filesystem::path folder_;
    std::uintmax_t mostBytes_;
};

}  // namespace ilf::app
