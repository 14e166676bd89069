// PFM: a text header of three lines, then 32-bit floats from the bottom row up (P. Debevec's format, as netpbm's pfm
// page describes it). A negative scale means little-endian.
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <locale>
#include <sstream>
#include <vector>

#include "projects/depth_file.h"
#include "projects/depth_formats.h"
#include "projects/pictures.h"

namespace ilf::projects {

namespace {

static_assert(std::endian::native == std::endian::little);

tl::unexpected<Error> damaged(const std::string& name, const std::string& what) {
    return fail(Fault::badFile, name + " is damaged: " + what + ". Export it again.");
}

}  // namespace

bool looksLikePfm(std::string_view bytes) { return bytes.starts_with("Pf") || bytes.starts_with("PF"); }

Result<DepthPixels> decodePfm(std::string_view bytes, const std::string& name) {
    if (bytes.starts_with("PF")) {
        return fail(Fault::badFile, name + " is a PFM of three colours, not of depth: it needs one channel (\"Pf\").");
    }
    constexpr std::size_t kLongestHeader = 256;
    std::istringstream header{std::string(bytes.substr(0, kLongestHeader))};
    header.imbue(std::locale::classic());
    std::string magic;
    std::int64_t width = 0, height = 0;
    double scale = 0.0;
    if (!(header >> magic >> width >> height >> scale)) return damaged(name, "its header is not that of a PFM");
    const auto start = header.tellg();
    if (width <= 0 || height <= 0 || scale == 0.0 || !std::isfinite(scale) || start < 0) {
        return damaged(name, "its header gives no size or scale");
    }
    if (width > kMaxPixels || height > kMaxPixels || width * height > kMaxPixels) {
        return fail(Fault::badFile, name + " claims more than 100 megapixels: scale it down first.");
    }
    const std::size_t first = static_cast<std::size_t>(start) + 1;  // one white space ends the header
    const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
    if (bytes.size() < first || bytes.size() - first < columns * rows * sizeof(float)) {
        return damaged(name, "it ends before its last row");
    }
    std::vector<float> metres(columns * rows);
    for (std::size_t y = 0; y < rows; ++y) {
        std::memcpy(metres.data() + (rows - 1 - y) * columns, bytes.data() + first + y * columns * sizeof(float),
                    columns * sizeof(float));
    }
    const float factor = static_cast<float>(std::abs(scale));
    for (float& value : metres) {
        if (scale > 0.0) value = std::bit_cast<float>(__builtin_bswap32(std::bit_cast<std::uint32_t>(value)));
        value *= factor;
    }
    return DepthPixels{Image<float>({static_cast<int>(width), static_cast<int>(height)}, 1, std::move(metres)), {}};
}

std::string encodeDepthPfm(const Image<float>& metres) {
    std::string bytes = "Pf\n" + std::to_string(metres.width()) + " " + std::to_string(metres.height()) + "\n-1.0\n";
    for (int y = metres.height() - 1; y >= 0; --y)
        bytes.append(reinterpret_cast<const char*>(metres.row(y)), metres.stride() * sizeof(float));
    return bytes;
}

}  // namespace ilf::projects
