// The unmodified LightCrafter driver and an emulated board on one virtual clock, with video that comes frame by frame.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "devices/clock.h"
#include "devices/comparison/light_comparison.h"
#include "devices/dlpc350/frame.h"
#include "devices/dlpc350/lightcrafter.h"
#include "devices/emulators/light_crafter.h"

namespace ilf::devices::test {

/// Time goes on only while the driver waits or the test says so; vertical syncs come at each multiple of a frame.
class Bench {
public:
    static constexpr std::int64_t kFrame_ns = 16'666'667;

    /// `locked` runs work while no program talks to the board; empty: nobody can.
    using Locked = std::function<void(const std::function<void()>&)>;
    explicit Bench(std::int64_t start_ns = 0, Locked locked = {});

    emulators::EmulatedLightCrafter board;
    /// What else goes on while time passes, called each 2 ms.
    std::function<void()> meanwhile;
    Locked locked;

    std::int64_t now_ns() const { return now_ns_; }
    void advance(std::int64_t by_ns);
    void frames(int count) { advance(count * kFrame_ns); }
    Clock clock();
    void present(const dlpc350::VideoPicture& picture);

    /// The light of the newest whole sweep, its times counted from the vertical sync it began with.
    std::vector<SlotLight> newestSweep();
    std::vector<emulators::LightSlot> takeLight();

private:
    std::int64_t now_ns_, nextSync_ns_;
    emulators::FramePtr frame_;
};

/// Light as the report's comparison takes it.
SlotLight taken(const emulators::LightSlot& slot, std::int64_t sweepStart_ns);
std::vector<SlotLight> intendedSweep(const Program& program, int depth);
/// A program of the projector's raster, `slots` a sweep, a picture of its own in most of them.
Program sweepOf(int slots, std::uint32_t seed);

/// The bus without libusb: transfers reach the board at once, and time limits are virtual.
class DirectLink : public UsbLink {
public:
    explicit DirectLink(Bench& bench) : bench_(&bench) {}
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
    Result<void> clearHalt(Endpoint endpoint) override;
    Result<std::unique_ptr<UsbStream>> streamOut(Endpoint, std::size_t, int,
                                                 std::function<void(std::span<std::uint8_t>)>) override {
        return fail(Fault::device, "no stream");
    }
    Result<std::unique_ptr<UsbStream>> streamIn(Endpoint, std::size_t, int,
                                                std::function<void(std::span<const std::uint8_t>)>) override {
        return fail(Fault::device, "no stream");
    }

private:
    Result<void> answered(emulators::UsbAnswer answer);
    Bench* bench_;
    UsbIdentity identity_{0x0451, 0x6401, "1-2", "DLPC350", ""};
    bool gone_ = false;
};

/// A cable that changes what is sent: `change` sees each packet before the board does.
class TamperingLink : public DirectLink {
public:
    using Change = std::function<void(std::span<std::uint8_t> packet)>;
    TamperingLink(Bench& bench, Change change) : DirectLink(bench), change_(std::move(change)) {}
    Result<void> send(Endpoint to, std::span<const std::uint8_t> data, Milliseconds limit) override {
        Bytes changed(data.begin(), data.end());
        change_(changed);
        return DirectLink::send(to, changed, limit);
    }

private:
    Change change_;
};

}  // namespace ilf::devices::test
