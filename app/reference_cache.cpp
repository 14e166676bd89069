#include "app/reference_cache.h"

#include <algorithm>
#include <cstring>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "projects/safe_file.h"
#include "projects/wave_checksum.h"
#include "projects/xdg.h"

namespace ilf::app {
namespace {

namespace fs = std::filesystem;

/// Header, noise floor, count of values, values, SHA-256 of all before. Numbers as this machine has them: caches do not
/// travel.
constexpr std::string_view kHeader = "IlluminatedFocus reference 1\n";
constexpr std::size_t kChecksum = 32;

template <class T>
void put(std::string& bytes, const T* values, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::size_t at = bytes.size();
    bytes.resize(at + count * sizeof(T));
    std::memcpy(bytes.data() + at, values, count * sizeof(T));
}

std::string checksumOf(std::string_view bytes) {
    projects::Sha256 sum;
    sum.add(bytes);
    const auto value = sum.value();
    std::string text;
    put(text, value.data(), value.size());
    return text;
}

template <class T>
std::string packed(double noiseFloor_dB, const T* values, std::size_t count) {
    std::string bytes(kHeader);
    const std::uint64_t many = count;
    put(bytes, &noiseFloor_dB, 1);
    put(bytes, &many, 1);
    put(bytes, values, count);
    return bytes + checksumOf(bytes);
}

template <class T>
struct Unpacked {
    double noiseFloor_dB = 0.0;
    std::vector<T> values;
};
template <class T>
std::optional<Unpacked<T>> unpacked(std::string_view bytes, std::size_t count) {
    const std::size_t before = kHeader.size() + sizeof(double) + sizeof(std::uint64_t);
    const std::size_t content = before + count * sizeof(T);
    if (bytes.size() != content + kChecksum || !bytes.starts_with(kHeader)) return std::nullopt;
    if (bytes.substr(content) != checksumOf(bytes.substr(0, content))) return std::nullopt;
    Unpacked<T> result;
    std::uint64_t many = 0;
    std::memcpy(&result.noiseFloor_dB, bytes.data() + kHeader.size(), sizeof(double));
    std::memcpy(&many, bytes.data() + kHeader.size() + sizeof(double), sizeof many);
    if (many != count) return std::nullopt;
    result.values.resize(count);
    if (count > 0) std::memcpy(result.values.data(), bytes.data() + before, count * sizeof(T));
    return result;
}

template <class T>
std::optional<Unpacked<T>> kept(const fs::path& path, std::size_t count) {
    const auto bytes = projects::readWhole(path, 64 + kHeader.size() + kChecksum + count * sizeof(T));
    if (!bytes) return std::nullopt;
    auto result = unpacked<T>(*bytes, count);
    std::error_code ignored;
    if (result) fs::last_write_time(path, fs::file_time_type::clock::now(), ignored);
    return result;
}

/// The ones least recently used first, until the others fit.
void forgetOld(const fs::path& folder, std::uintmax_t mostBytes) {
    struct Kept {
        fs::path path;
        fs::file_time_type used;
        std::uintmax_t bytes;
    };
    std::vector<Kept> all;
    std::uintmax_t sum = 0;
    std::error_code error;
    for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
        std::error_code gone;
        Kept one{at->path(), at->last_write_time(gone), at->file_size(gone)};
        if (gone || one.path.extension() != ".rays") continue;
        sum += one.bytes;
        all.push_back(std::move(one));
    }
    std::ranges::sort(all, {}, &Kept::used);
    for (const Kept& one : all) {
        if (sum <= mostBytes) return;
        projects::removeQuietly(one.path);
        sum -= one.bytes;
    }
}

/// What cannot be kept is traced again the next time.
void keep(const fs::path& path, std::uintmax_t mostBytes, std::string_view bytes) {
    if (projects::makeFolders(path.parent_path()) && projects::writeAtomically(path, bytes))
        forgetOld(path.parent_path(), mostBytes);
}

}  // namespace

ReferenceCache::ReferenceCache() : ReferenceCache(projects::cacheDir() / "reference") {}
ReferenceCache::ReferenceCache(fs::path folder, std::uintmax_t mostBytes)
    : folder_(std::move(folder)), mostBytes_(mostBytes) {}

Result<ReferencePicture> ReferenceCache::picture(const Reference& reference, const ReferenceRays& rays) const {
    const fs::path path = folder_ / (reference.key(rays) + ".rays");
    const Size size = reference.size();
    const std::size_t count = 3 * static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height);
    if (auto found = kept<float>(path, count))
        return ReferencePicture{Radiance(size, 3, std::move(found->values)), found->noiseFloor_dB};
    auto traced = reference.picture(rays);
    if (traced) keep(path, mostBytes_, packed(traced->noiseFloor_dB, traced->radiance.pixels().data(), count));
    return traced;
}

Result<ReferencePixels> ReferenceCache::pixels(const Reference& reference, std::span<const ViewPixel> pixels,
                                               const ReferenceRays& rays) const {
    if (pixels.empty()) return reference.pixels(pixels, rays);
    const fs::path path = folder_ / (reference.key(rays, pixels) + ".rays");
    using Colour = std::array<double, 3>;
    if (auto found = kept<Colour>(path, pixels.size()))
        return ReferencePixels{std::move(found->values), found->noiseFloor_dB};
    auto traced = reference.pixels(pixels, rays);
    if (traced) keep(path, mostBytes_, packed(traced->noiseFloor_dB, traced->radiance.data(), pixels.size()));
    return traced;
}

}  // namespace ilf::app
