// The studio's end of the link: keeps an output core running and sends it the newest program, on a thread of its own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "app/studio/worker.h"
#include "core/base/latest.h"
#include "devices/link/messages.h"

namespace ilf::app {

/// A program on its way to light. Newest wins; a take is never replaced by a live update that came later unless that
/// one is a take as well (it then carries the newer program).
struct Sending {
    std::shared_ptr<const Compiled> compiled;
    std::uint64_t revision = 0;
    devices::Why why = devices::Why::live;
    std::uint64_t hold = 0;  ///< Status::hold when the operator pressed TAKE: the one it may end
};

/// What the link says, newest wins.
struct LinkNews {
    devices::Status status;
    std::string trouble;  ///< why no core could be started or a program not be sent; empty when all is well
    std::optional<Result<void>> lent{};  ///< while devices are lent: the core has ended, or would not
};

class Link {
public:
    Link(std::string coreProgram, std::vector<std::string> coreArguments, std::filesystem::path runtimeDirectory,
         std::function<void()> onNews);

    void send(Sending sending);
    void safeLight();
    /// Stops the core that runs, in safe light, and starts one with these arguments.
    void restartCore(std::vector<std::string> arguments);
    /// Stops the core, in safe light (a projector's display stays white), and starts none until devices are taken back:
    /// somebody measures with them.
    void lendDevices();
    void takeDevicesBack();
    std::optional<LinkNews> tryTake() { return news_.tryTake(); }

private:
    void run(std::stop_token stop);

    std::string coreProgram_;
    std::vector<std::string> coreArguments_;
    std::filesystem::path runtimeDirectory_;
    std::function<void()> onNews_;
    std::mutex mutex_;
    std::optional<Sending> next_;
    bool safe_ = false;
    std::optional<std::vector<std::string>> restart_;
    bool lend_ = false;
    Latest<LinkNews> news_;
    std::jthread thread_;  // last: joins before what it uses goes
};

}  // namespace ilf::app
