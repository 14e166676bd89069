// A scripted DLPC350 behind a UsbLink, with bytes written by hand from the reference; every call can be made to fail.
#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "devices/clock.h"
#include "devices/usb/usb_link.h"

namespace ilf::devices::test {

/// Commands are u16: CMD2 in the high byte.
class FakeBoard : public UsbLink {
public:
    FakeBoard();

    // What the test may turn.
    std::map<int, Bytes> registers;  ///< what reads answer
    std::map<int, Bytes> lies;       ///< reads of these answer this instead
    std::set<int> refuses, ignores;  ///< NACK; no answer (the command is not done)
    std::set<int> losesAck;          ///< done, but not acknowledged
    int startsNeeded = 2;            ///< until the sequencer runs
    int busyChecks = 2;              ///< reads of 1A/1A that still say busy
    Bytes checkResult{0x08};
    int failAt = 0;  ///< the n-th call from now on fails; 0: none
    int calls = 0;
    std::deque<Bytes> replies;       ///< what lies ready; a test may put old ones in
    std::vector<std::string> told;   ///< writes done: "1A1B 01"
    std::vector<std::string> asked;  ///< reads: "1A1B"
    bool unplugged = false;

    bool patternMode() const { return registers.at(0x1A1B)[0] == 1; }
    bool runs() const { return registers.at(0x1A24)[0] == 2; }
    bool touched() const { return !told.empty(); }
    /// The board's own controller switches to video when HDMI appears.
    void flipToVideo();

    const UsbIdentity& identity() const override { return identity_; }
    Result<Endpoint> interruptOut() const override { return Endpoint{0x01}; }
    Result<Endpoint> interruptIn() const override { return Endpoint{0x81}; }
    Result<Endpoint> bulkOut() const override { return fail(Fault::device, "no bulk"); }
    Result<Endpoint> bulkIn() const override { return fail(Fault::device, "no bulk"); }
    Result<void> send(Endpoint to, std::span<const std::uint8_t> data, Milliseconds limit) override;
    Result<Bytes> receive(Endpoint from, std::size_t most, Milliseconds limit) override;
    Result<void> controlOut(const VendorRequest&, std::span<const std::uint8_t>, Milliseconds) override {
        return fail(Fault::device, "no control");
    }
    Result<Bytes> controlIn(const VendorRequest&, std::size_t, Milliseconds) override {
        return fail(Fault::device, "no control");
    }
    Result<void> clearHalt(Endpoint) override { return {}; }
    Result<std::unique_ptr<UsbStream>> streamOut(Endpoint, std::size_t, int,
                                                 std::function<void(std::span<std::uint8_t>)>) override {
        return fail(Fault::device, "no stream");
    }
    Result<std::unique_ptr<UsbStream>> streamIn(Endpoint, std::size_t, int,
                                                std::function<void(std::span<const std::uint8_t>)>) override {
        return fail(Fault::device, "no stream");
    }

private:
    void obey();
    void answer(Bytes message);

    UsbIdentity identity_{0x0451, 0x6401, "1-2", "DLPC350", ""};
    Bytes incoming_;  ///< a message's packets so far
    int starts_ = 0, checks_ = 0, offset_ = 0;
};

/// A clock that jumps, and counts how long a driver waited.
struct JumpingClock {
    std::chrono::nanoseconds time{0};
    Clock clock() {
        return {[this] { return time; }, [this](std::chrono::nanoseconds t) { time += t; }};
    }
};

}  // namespace ilf::devices::test
