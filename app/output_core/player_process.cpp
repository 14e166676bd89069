#include <spdlog/spdlog.h>
#include <sys/eventfd.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>
#include <memory>

#include "app/output_core/log.h"
#include "app/output_core/player.h"
#include "app/output_core/priority.h"
#include "app/output_core/roles.h"
#include "app/output_core/signals.h"
#include "app/output_core/studio_link.h"
#include "devices/link/runtime_directory.h"
#include "devices/simulated/device_client.h"
#include "devices/simulated/simulated_stage.h"

namespace ilf::app {
namespace {

/// The stage with the connection it plays over.
class ConnectedStage : public devices::Stage {
public:
    explicit ConnectedStage(const std::filesystem::path& runtimeDirectory) : client_(runtimeDirectory) {}
    Result<void> load(const Program& program) override { return stage_.load(program); }
    Result<void> swap() override { return stage_.swap(); }
    Result<void> heartbeat() override { return stage_.heartbeat(); }
    void safeLight() noexcept override { stage_.safeLight(); }
    devices::StageReport report() const override { return stage_.report(); }
    std::string name() const override { return stage_.name(); }

private:
    devices::DeviceClient client_;
    devices::SimulatedStage stage_{client_};
};

}  // namespace

int runPlayer(const std::filesystem::path& runtimeDirectory, const std::string& afterFault) {
    const Signals signals{SIGTERM, SIGINT};
    prctl(PR_SET_NAME, "ilf-player");
    comeFirst();
    startLog("output-core-player");
    const auto lock = devices::FileLock::tryTake(devices::playerLock(runtimeDirectory));
    if (!lock || !*lock) {
        spdlog::error("{}", lock ? "another player runs in this runtime directory" : lock.error().what);
        return 3;
    }
    auto server = devices::Server::open(devices::coreAddress(runtimeDirectory));
    if (!server) {
        spdlog::error("{}", server.error().what);
        return 3;
    }
    const int wake = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    {
        Player player(
            std::make_unique<ConnectedStage>(runtimeDirectory), [wake] { eventfd_write(wake, 1); }, afterFault);
        StudioLink link(*std::move(server), player);
        spdlog::info("player started in safe light");
        while (signals.arrived(0).empty()) {
            link.turn(wake, signals.descriptor());
            eventfd_t count = 0;
            eventfd_read(wake, &count);
        }
    }
    close(wake);
    spdlog::info("player stopped in safe light");
    return 0;
}

}  // namespace ilf::app
