// A USB device that is not there, for tests of the bus itself: it echoes, swallows, gives, refuses, and can be pulled
// out.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <vector>

namespace ilf::devices::test {

/// 0451:6401 at 1-2, one interface held by a kernel driver: interrupt 01/81 echo, bulk 02 swallows, bulk 86 gives tens
/// of sevens, vendor request 99 stalls, all others are answered 08 00. Works only where umockdev is preloaded.
class MockUsb {
public:
    static bool preloaded();
    MockUsb();
    ~MockUsb();
    MockUsb(const MockUsb&) = delete;
    MockUsb& operator=(const MockUsb&) = delete;

    void plugIn();
    void pullOut();
    /// Somebody else claims the interface.
    void setBusy(bool busy);
    bool kernelDriverSentAway() const;
    std::size_t swallowed() const;  ///< bytes that came to bulk 02
    std::size_t inFlight() const;   ///< transfers the kernel holds

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace ilf::devices::test
