#include "devices/emulated_scene/shown_light.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <thread>

#include "devices/link/rig_environment.h"
#include "devices/link/runtime_directory.h"

namespace ilf::devices {
namespace {

/// An emulated rig on a busy machine answers late.
constexpr std::chrono::milliseconds kPatience{1500};

std::size_t countOf(Size size) { return static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height); }

}  // namespace

ShownLightReader::ShownLightReader(std::filesystem::path runtimeDirectory) : directory_(std::move(runtimeDirectory)) {}
ShownLightReader::~ShownLightReader() = default;

ShownLight ShownLightReader::during(Second exposure) {
    const ShownLight dark{raster_, std::vector<float>(countOf(raster_), 0.0F), false};
    std::error_code ignored;
    if (!FileLock::holder(devicesLock(directory_))) {
        client_.reset();
        past_.clear();
        return dark;
    }
    if (!client_) client_ = std::make_unique<DeviceClient>(directory_, kPatience);
    const bool emulated = std::filesystem::exists(rigEnvironmentFile(directory_), ignored);
    ShownLight shown = emulated ? ofEmulated(exposure) : ofSimulated(exposure);
    if (!shown.there) return dark;
    raster_ = shown.raster;
    return shown;
}

Result<std::vector<float>> ShownLightReader::slots(const DeviceState& state) {
    std::map<std::uint64_t, std::vector<float>> images;
    std::vector<float> sum;
    const float share = 1.0F / static_cast<float>(std::max<std::size_t>(1, state.slotHashes.size()));
    for (std::size_t slot = 0; slot < state.slotHashes.size(); ++slot) {
        const std::uint64_t hash = state.slotHashes[slot];
        if (hash == 0) continue;
        if (!images.contains(hash)) {
            if (const auto known = images_.find(hash); known != images_.end()) {
                images[hash] = known->second;
            } else {
                const auto image = client_->readSlot(static_cast<int>(slot));
                if (!image) return tl::unexpected(image.error());
                const auto picture = toImage(image->image);
                raster_ = picture.size();
                auto& light = images[hash];
                light.reserve(picture.pixels().size());
                for (const std::uint8_t value : picture.pixels())
                    light.push_back(static_cast<float>(value) / 255.0F);
            }
        }
        const auto& light = images[hash];
        sum.resize(light.size());
        for (std::size_t i = 0; i < light.size(); ++i)
            sum[i] += share * light[i];
    }
    images_ = std::move(images);
    sum.resize(countOf(raster_));
    return sum;
}

ShownLight ShownLightReader::ofSimulated(Second exposure) {
    const auto state = client_->readState();
    if (!state) return {};
    const bool steady = state->light == LightMode::steady;
    const std::uint64_t shown = steady ? 0 : state->hashShown;
    if (past_.empty() || shown != shown_) {
        auto light = steady ? std::vector<float>(countOf(raster_), 1.0F) : slots(*state).value_or(std::vector<float>());
        if (light.empty()) return {};
        const std::int64_t since = steady ? state->now_ns : state->swapped_ns;
        if (!past_.empty() && past_.back().light.size() != light.size()) past_.clear();
        past_.push_back({since, std::move(light)});
        shown_ = shown;
    }
    // What was on show for how much of the exposure.
    const std::int64_t end = state->now_ns, begin = end - static_cast<std::int64_t>(1e9 * exposure.si());
    while (past_.size() > 1 && past_[1].from_ns <= begin)
        past_.pop_front();
    if (past_.size() == 1) return {raster_, past_.front().light, true};
    ShownLight mean{raster_, std::vector<float>(countOf(raster_), 0.0F), true};
    for (std::size_t i = 0; i < past_.size(); ++i) {
        const std::int64_t from = i == 0 ? begin : std::max(begin, past_[i].from_ns);
        const std::int64_t to = i + 1 < past_.size() ? std::max(begin, past_[i + 1].from_ns) : end;
        const auto share = static_cast<float>(static_cast<double>(std::max<std::int64_t>(0, to - from)) /
                                              static_cast<double>(std::max<std::int64_t>(1, end - begin)));
        for (std::size_t k = 0; k < mean.light.size(); ++k)
            mean.light[k] += share * past_[i].light[k];
    }
    return mean;
}

Result<ShownLight> ShownLightReader::newestSweep(Second& sweep) {
    const auto received = client_->readReceived();
    if (!received) return tl::unexpected(received.error());
    sweep = received->sweep;
    ShownLight shown{received->raster, std::vector<float>(countOf(received->raster), 0.0F), true};
    for (std::size_t i = 0; i < received->exposures.size(); ++i) {
        const Exposure& exposure = received->exposures[i];
        if (exposure.colours == 0) continue;
        const auto light = client_->readExposure(static_cast<int>(i));
        if (!light) return tl::unexpected(light.error());
        if (light->light.size() != shown.light.size()) continue;
        const auto share = static_cast<float>((exposure.length / received->sweep) *
                                              std::popcount(exposure.colours & 7U) / 3.0 / 255.0);
        for (std::size_t k = 0; k < shown.light.size(); ++k)
            shown.light[k] += share * static_cast<float>(light->light[k]);
    }
    return shown;
}

ShownLight ShownLightReader::ofEmulated(Second exposure) {
    Second sweep;
    auto first = newestSweep(sweep);
    if (!first) return {};
    const Second rest = exposure - sweep;
    if (rest < 0.5 * sweep) return *std::move(first);
    std::this_thread::sleep_for(std::chrono::duration<double>(rest.si()));
    auto last = newestSweep(sweep);
    if (!last) return {};
    if (last->raster != first->raster) return *std::move(last);
    for (std::size_t k = 0; k < last->light.size(); ++k)
        last->light[k] = 0.5F * (last->light[k] + first->light[k]);
    return *std::move(last);
}

}  // namespace ilf::devices
