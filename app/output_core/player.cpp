#include "app/output_core/player.h"

#include <unistd.h>

#include <chrono>
#include <exception>
#include <utility>

#include "devices/link/runtime_directory.h"

namespace ilf::app {
namespace {

// Half of what a device may stay silent before the studio would call it gone.
constexpr std::chrono::milliseconds kHeartbeat{100};
// Another sweep starts in steady light: slots, steady, slots. A region dragged live would ask for one with every
// update, and the room would flicker at 10-15 Hz, inside the 3-30 Hz that photosensitive people must be spared. One
// start a second stays far below; until then the program before plays on.
constexpr std::int64_t kBetweenSweepStarts_ns = 1'000'000'000;

}  // namespace

Player::Player(std::unique_ptr<devices::Stage> stage, std::function<void()> changed, const std::string& afterFault,
               std::vector<std::string> limits)
    : stage_(std::move(stage)), changed_(std::move(changed)), turned_ns_(devices::monotonicNs()),
      // Never the number of a player before this one: a take meant for that one must not end this one's hold.
      lastHold_(static_cast<std::uint64_t>(devices::monotonicNs())) {
    status_.pid = getpid();
    status_.supervisorPid = getppid();
    status_.hold = lastHold_;
    status_.fault = afterFault;
    status_.faults = afterFault.empty() ? 0 : 1;
    status_.limits = std::move(limits);
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

void Player::play(Order order) {
    if (const auto before = orders_.tryTake(); before && *before) ++replaced_;
    orders_.put(std::move(order));
}

void Player::safeLight() {
    ++safeLightsAsked_;
    if (const auto before = orders_.tryTake(); before && *before) ++replaced_;
    orders_.put(std::nullopt);
}

std::chrono::nanoseconds Player::busyFor() const {
    return std::chrono::nanoseconds(devices::monotonicNs() - turned_ns_);
}

void Player::run(const std::stop_token& stop) {
    say();  // first: devices that are looked for make safe light slow
    stage_->safeLight();
    while (!stop.stop_requested()) {
        turned_ns_ = devices::monotonicNs();
        try {
            auto order = orders_.takeWithin(stop, kHeartbeat);
            if (stop.stop_requested()) break;
            // Counted, not posted: a program that comes right behind it cannot make it disappear.
            if (const auto asked = safeLightsAsked_.load(); asked != safeLightsDone_) {
                safeLightsDone_ = asked;
                hold();
                stage_->safeLight();
            }
            if (order && *order && std::exchange(deferred_, std::nullopt)) ++replaced_;
            if (!(order && *order) && deferred_ && !startsTooSoon(*deferred_))
                order = std::exchange(deferred_, std::nullopt);
            if (order && *order) obey(**order);
            // Also between orders that follow fast or wait for their time: the devices watch for a silent player.
            const bool due = devices::monotonicNs() - heard_ns_ > std::chrono::nanoseconds(kHeartbeat).count();
            if (!(order && *order) || due) beat();
            say();
        } catch (const std::exception& error) {
            fault(std::string("The output core failed: ") + error.what() + ".");
        }
    }
    stage_->safeLight();
    say();
    ended_ = true;
}

void Player::hold() {
    deferred_.reset();
    playing_.reset();
    status_.hold = ++lastHold_;
    status_.revisionPlayed = 0;
    status_.contentHashPlayed = 0;
}

void Player::fault(const std::string& what) {
    status_.fault = what;
    ++status_.faults;
    hold();
    say();  // first: a device that does not answer makes safe light slow
    stage_->safeLight();
}

bool Player::startsTooSoon(const Order& order) const {
    const bool another = playing_ && (*playing_ != order.program.waveform || slotRate_ != order.program.slotRate);
    return another && devices::monotonicNs() - sweepStarted_ns_ < kBetweenSweepStarts_ns;
}

void Player::obey(const Order& order) {
    const bool released = order.why == devices::Why::take && order.hold == status_.hold;
    if (status_.hold != 0 && !released) {
        status_.lastRefusal = "Safe light is held; press TAKE to play again.";
        ++refused_;
        return;
    }
    if (const auto fine = checked(order.program); !fine) {
        status_.lastRefusal = fine.error().what;
        return;
    }
    if (startsTooSoon(order)) {
        deferred_ = order;
        return;
    }
    const auto loaded = stage_->load(order.program);
    const std::int64_t loaded_ns = devices::monotonicNs();
    const auto shown = loaded ? stage_->swap() : loaded;
    if (!shown) return fault(shown.error().what);
    well_ = true;
    heard_ns_ = devices::monotonicNs();
    if (!playing_ || *playing_ != order.program.waveform || slotRate_ != order.program.slotRate) {
        sweepStarted_ns_ = devices::monotonicNs();
    }
    playing_ = order.program.waveform;
    slotRate_ = order.program.slotRate;
    status_.hold = 0;
    status_.fault.clear();
    status_.lastRefusal.clear();
    status_.revisionPlayed = order.revision;
    status_.contentHashPlayed = order.hash;
    ++status_.swaps;
    status_.received_ns = order.received_ns;
    status_.loaded_ns = loaded_ns;
    status_.swapped_ns = devices::monotonicNs();
}

void Player::beat() {
    const auto alive = stage_->heartbeat();
    heard_ns_ = devices::monotonicNs();
    if (alive) {
        well_ = true;
        return;
    }
    // One fault for each loss, not one for each beat while it lasts; safe light is asked for until somebody listens.
    if (std::exchange(well_, false) || status_.hold == 0)
        fault(alive.error().what);
    else
        stage_->safeLight();
}

void Player::say() {
    const auto report = stage_->report();
    status_.light = report.light;
    status_.lens = report.lens;
    status_.lensPower = report.lensPower;
    status_.low = report.low;
    status_.high = report.high;
    status_.projectorLine = report.projectorLine;
    status_.lensLine = report.lensLine;
    status_.lensName = report.lensName;
    status_.projectorWell = status_.lensWell = report.well;
    status_.simulated = report.simulated;
    status_.emulated = report.emulated;
    status_.timing = report.timing;
    status_.lensTemperature_C = report.lensTemperature_C;
    status_.devices = report.devices;
    give();
}

void Player::give() {
    status_.droppedUpdates = refused_ + replaced_.load();
    given_.put(status_);
    changed_();
}

}  // namespace ilf::app
