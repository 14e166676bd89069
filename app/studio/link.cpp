#include "app/studio/link.h"

#include "app/output_core/roles.h"
#include "devices/link/core_link.h"
#include "devices/link/runtime_directory.h"
#include "devices/link/start_core.h"

namespace ilf::app {
namespace {

/// Short enough that a program waits hardly at all, long enough to leave the processor alone.
constexpr std::chrono::milliseconds kPoll{2};
/// A core that has not answered for this long is started anew.
constexpr std::chrono::seconds kGone{2};

}  // namespace

Link::Link(std::string coreProgram, std::vector<std::string> coreArguments, std::filesystem::path runtimeDirectory,
           std::function<void()> onNews)
    : coreProgram_(std::move(coreProgram)), coreArguments_(std::move(coreArguments)),
      runtimeDirectory_(std::move(runtimeDirectory)), onNews_(std::move(onNews)),
      thread_([this](std::stop_token stop) { run(stop); }) {}

void Link::send(Sending sending) {
    const std::scoped_lock lock(mutex_);
    // A live update must not undo a take that has not left yet.
    if (next_ && next_->why == devices::Why::take && sending.why == devices::Why::live) {
        sending.why = devices::Why::take;
        sending.hold = next_->hold;
    }
    next_ = std::move(sending);
}

void Link::safeLight() {
    const std::scoped_lock lock(mutex_);
    safe_ = true;
    next_.reset();
}

void Link::restartCore(std::vector<std::string> arguments) {
    const std::scoped_lock lock(mutex_);
    restart_ = std::move(arguments);
    next_.reset();
}

void Link::lendDevices() {
    const std::scoped_lock lock(mutex_);
    lend_ = true;
    next_.reset();
}

void Link::takeDevicesBack() {
    const std::scoped_lock lock(mutex_);
    lend_ = false;
}

void Link::run(std::stop_token stop) {
    LinkNews last;
    const auto publish = [&](const LinkNews& news) {
        news_.put(news);
        last = news;
        onNews_();
    };
    if (const auto started = devices::ensureCoreRunning(coreProgram_, runtimeDirectory_, coreArguments_); !started) {
        publish({{}, started.error().what});
    }
    devices::CoreLink core(runtimeDirectory_);
    auto heard = Clock::now();
    std::optional<Result<void>> lent;  // as long as devices are lent
    while (!stop.stop_requested()) {
        std::optional<Sending> sending;
        bool safe = false;
        std::optional<std::vector<std::string>> restart;
        bool lend = false;
        {
            const std::scoped_lock lock(mutex_);
            safe = std::exchange(safe_, false);
            restart = std::exchange(restart_, std::nullopt);
            lend = lend_;
            if (core.status().connected) sending = std::exchange(next_, std::nullopt);
        }
        std::string trouble;
        if (restart) {
            coreArguments_ = *std::move(restart);
            if (devices::FileLock::holder(devices::supervisorLock(runtimeDirectory_)))
                // White stays on a real projector; there is no emulated one any more.
                stopSupervisor(runtimeDirectory_, core.status().simulated);
            const auto started = devices::ensureCoreRunning(coreProgram_, runtimeDirectory_, coreArguments_);
            if (!started) trouble = started.error().what;
        }
        if (lend && !lent) {
            lent = Result<void>();
            if (devices::FileLock::holder(devices::supervisorLock(runtimeDirectory_)) &&
                stopSupervisor(runtimeDirectory_, false) == 1)
                lent = fail(Fault::device, "The output core does not let go of the rig: it does not stop. Stop it "
                                           "with illuminatedfocus-core --stop, then begin again.");
        } else if (!lend && lent) {
            lent.reset();
            heard = Clock::now() - kGone;
        }
        if (safe && !lent) {
            if (const auto done = core.safeLight(); !done) trouble = done.error().what;
        }
        if (sending) {
            const auto sent = core.send(sending->compiled->program, sending->revision, sending->why, sending->hold);
            if (!sent) trouble = sent.error().what;
        }
        const auto status = core.poll(kPoll);
        if (status || !trouble.empty() || lent.has_value() != last.lent.has_value())
            publish({status ? *status : core.status(), trouble, lent});
        if (core.status().connected) {
            heard = Clock::now();
        } else if (!lent && Clock::now() - heard > kGone) {
            heard = Clock::now();
            const auto started = devices::ensureCoreRunning(coreProgram_, runtimeDirectory_, coreArguments_);
            if (!started && started.error().what != last.trouble) publish({core.status(), started.error().what});
        }
    }
}

}  // namespace ilf::app
