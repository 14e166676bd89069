// Plays the newest program on a stage, and goes to safe light at the first fault.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "core/base/latest.h"
#include "devices/link/messages.h"
#include "devices/stage.h"

namespace ilf::app {

/// A program with what the studio said about it.
struct Order {
    Program program;
    std::uint64_t revision = 0;
    std::uint64_t hash = 0;
    devices::Why why = devices::Why::live;
    std::uint64_t hold = 0;  ///< the hold that whoever sent it knew of
    std::int64_t received_ns = 0;
};

/// Owns the stage in a thread of its own. Begins in safe light and holds it; every fault holds it again. Held safe
/// light ends only with a take that names this very hold, so that neither a restart, nor a fault, nor a program that
/// was on its way can bring slots back by itself.
class Player {
public:
    /// `changed` is called from the player's thread after each change of the status.
    /// `afterFault`, if not empty, is told as the first fault: why the player before this one ended. `limits`: what the
    /// machine does not allow, for the status.
    Player(std::unique_ptr<devices::Stage> stage, std::function<void()> changed, const std::string& afterFault = {},
           std::vector<std::string> limits = {});

    /// The newest order wins; one that was not begun is dropped and counted.
    void play(Order order);
    void safeLight();
    /// The newest status since the last call, if there is one.
    std::optional<devices::Status> newStatus() { return given_.tryTake(); }
    /// Begins the end, in safe light, which real devices take seconds for; the object may go once it `ended`.
    void end() { thread_.request_stop(); }
    bool ended() const { return ended_; }
    /// How long its thread has been at one thing.
    std::chrono::nanoseconds busyFor() const;

private:
    void run(const std::stop_token& stop);
    void obey(const Order& order);
    bool startsTooSoon(const Order& order) const;
    void beat();
    void hold();
    void fault(const std::string& what);
    void say();
    void give();

    std::unique_ptr<devices::Stage> stage_;
    std::function<void()> changed_;
    Latest<std::optional<Order>> orders_;  ///< an empty one only wakes the thread
    Latest<devices::Status> given_;
    std::atomic<std::uint64_t> safeLightsAsked_ = 0;
    std::atomic<std::uint64_t> replaced_ = 0;  ///< orders that a newer one replaced
    std::atomic<std::int64_t> turned_ns_;      ///< when its thread last began something
    std::atomic<bool> ended_ = false;
    // Of the player's thread alone:
    std::uint64_t safeLightsDone_ = 0;
    std::uint64_t lastHold_;
    std::uint64_t refused_ = 0;  ///< orders that came while safe light was held
    bool well_ = false;
    std::optional<Order> deferred_;    ///< waits until another sweep may start
    std::optional<Waveform> playing_;  ///< of the program on show
    Hertz slotRate_;
    std::int64_t sweepStarted_ns_ = 0;
    std::int64_t heard_ns_ = 0;  ///< when the devices were last talked to
    devices::Status status_;
    std::jthread thread_;  // last: joins before what it uses goes
};

}  // namespace ilf::app
