#include "tests/devices/emulated_rig/running_rig.h"

#include <doctest/doctest.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>

#include "devices/dlpc350/lightcrafter.h"
#include "devices/emulated_rig/emulated_rig.h"
#include "devices/link/runtime_directory.h"
#include "devices/rig/pattern_frames.h"
#include "devices/rig/usb1208_lens.h"
#include "devices/video/display_output.h"

namespace ilf::devices::test {

using namespace std::chrono_literals;

RunningRig::RunningRig(LensPreset lens) : stop_(eventfd(0, EFD_CLOEXEC)) {
    static std::atomic<int> count = 0;
    directory_ = std::filesystem::temp_directory_path() /
                 ("ilf-rig-" + std::to_string(getpid()) + "-" + std::to_string(++count));
    REQUIRE(prepareRuntimeDirectory(directory_));
    server_ = std::thread([this, lens] {
        served_ = serveEmulatedRig(directory_, lens, stop_, [](const std::string&) {});
        ended_ = true;
    });
    // Until it is ready or has refused; both are the rig's to say.
    Result<RigEnvironment> environment = rigEnvironment(directory_);
    while (!environment && !ended_) {
        std::this_thread::sleep_for(10ms);
        environment = rigEnvironment(directory_);
    }
    if (!environment) {
        server_.join();
        refused_ = served_ ? "it ended at once" : served_.error().what;
        return;
    }
    for (const auto& [name, value] : *environment)
        if (name != "LD_PRELOAD") setenv(name.c_str(), value.c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
    client_ = std::make_unique<DeviceClient>(directory_, 2000ms);
    bus_ = *UsbBus::open();
}

RunningRig::~RunningRig() {
    bus_.reset();
    client_.reset();
    if (server_.joinable()) {
        eventfd_write(stop_, 1);
        server_.join();
    }
    close(stop_);
    std::error_code error;
    std::filesystem::remove_all(directory_, error);
}

bool RunningRig::befalls(const std::string& device, const std::string& kind, std::uint64_t after, std::uint64_t times,
                         double amount) {
    const auto done = client_->mishap({device, kind, after, times, amount});
    if (!done) MESSAGE(done.error().what);
    return done.has_value();
}

std::unique_ptr<LightCrafterStage> RunningRig::stage(int bits) {
    LightCrafterRig rig;
    rig.openProjector = [this]() -> Result<std::unique_ptr<StageProjector>> {
        auto link = bus_->link(kEmulatedProjectorAt, dlpc350::LightCrafter::kInterface);
        if (!link) return tl::unexpected(link.error());
        auto board = dlpc350::LightCrafter::open(*std::move(link), Clock::steady());
        if (!board) return tl::unexpected(board.error());
        return std::make_unique<LightCrafterProjector>(*std::move(board));
    };
    rig.openLens = [this](Dioptre rest) -> Result<std::unique_ptr<StageLens>> {
        auto link = bus_->link(kEmulatedLensesAt, 0);
        if (!link) return tl::unexpected(link.error());
        LensOutputSetup setup;
        setup.transfersInFlight = 20;  // this machine may do much else
        return Usb1208Lens::open(*std::move(link), setup, rest);
    };
    rig.video = *displayOutput({{}, {912, 1140}});
    rig.packed = patternFrames(bits);
    rig.emulated = true;
    return std::make_unique<LightCrafterStage>(std::move(rig));
}

std::vector<SlotLight> receivedSweep(DeviceClient& client, Received& received) {
    auto answer = client.readReceived();
    REQUIRE(answer);
    received = *std::move(answer);
    std::vector<SlotLight> sweep;
    for (const Exposure& exposure : received.exposures) {
        auto light = client.readExposure(static_cast<int>(sweep.size()));
        REQUIRE(light);
        SlotLight slot{{light->raster, 1, std::move(light->light)}, exposure.start, exposure.length, exposure.colours};
        sweep.push_back(std::move(slot));
    }
    return sweep;
}

std::optional<std::string> playedFor(LightCrafterStage& stage, std::chrono::milliseconds time) {
    const auto end = std::chrono::steady_clock::now() + time;
    while (std::chrono::steady_clock::now() < end) {
        std::this_thread::sleep_for(100ms);
        if (const auto well = stage.heartbeat(); !well) return well.error().what;
    }
    return std::nullopt;
}

}  // namespace ilf::devices::test
