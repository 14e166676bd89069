// The whole stage with the unmodified drivers of projector and lenses, emulated devices at the end of their cables, and
// one virtual clock. Every transfer and every picture can be made to fail.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "devices/emulators/daq.h"
#include "devices/emulators/trigger_wire.h"
#include "devices/rig/lightcrafter_stage.h"
#include "tests/devices/endtoend/bench.h"

namespace ilf::devices::test {

/// Asked before each call of a cable; true: it fails.
using Spoils = std::function<bool()>;

/// The converter's cable. Streams move whenever time passes, as the bus would.
class DaqLink final : public UsbLink {
public:
    /// `open`: who has to be told of it while it is there.
    DaqLink(Bench& bench, emulators::EmulatedDaq& daq, DaqLink*& open) : bench_(bench), daq_(daq), open_(open) {
        open_ = this;
    }
    ~DaqLink() override {
        if (open_ == this) open_ = nullptr;
    }
    const UsbIdentity& identity() const override { return identity_; }
    Result<Endpoint> interruptOut() const override { return fail(Fault::device, "no interrupts"); }
    Result<Endpoint> interruptIn() const override { return fail(Fault::device, "no interrupts"); }
    Result<Endpoint> bulkOut() const override { return Endpoint{0x02}; }
    Result<Endpoint> bulkIn() const override { return Endpoint{0x81}; }
    Result<void> send(Endpoint, std::span<const std::uint8_t>, Milliseconds) override {
        return fail(Fault::device, "only streams");
    }
    Result<Bytes> receive(Endpoint, std::size_t, Milliseconds) override { return fail(Fault::device, "only streams"); }
    Result<void> controlOut(const VendorRequest& request, std::span<const std::uint8_t> data, Milliseconds) override;
    Result<Bytes> controlIn(const VendorRequest& request, std::size_t length, Milliseconds limit) override;
    Result<void> clearHalt(Endpoint endpoint) override;
    Result<std::unique_ptr<UsbStream>> streamOut(Endpoint to, std::size_t bytes, int inFlight,
                                                 std::function<void(std::span<std::uint8_t>)> fill) override;
    Result<std::unique_ptr<UsbStream>> streamIn(Endpoint from, std::size_t bytes, int inFlight,
                                                std::function<void(std::span<const std::uint8_t>)> taken) override;
    /// What is in flight goes on.
    void pump();
    /// The cable was pulled: what is in flight ends.
    void pulled();

private:
    struct Out;
    struct In;
    Result<std::size_t> control(std::uint8_t type, const VendorRequest& request, std::span<std::uint8_t> data);
    static tl::unexpected<Error> failed(emulators::UsbAnswer answer);
    emulators::UsbAnswer noticed(emulators::UsbAnswer answer);

    Bench& bench_;
    emulators::EmulatedDaq& daq_;
    DaqLink*& open_;
    Out* out_ = nullptr;
    In* in_ = nullptr;
    bool gone_ = false;  ///< its cable was pulled in the middle of a transfer
    UsbIdentity identity_{0x09DB, 0x00E8, "1-3", "USB-1208FS-Plus", "01F0A1B2"};
};

/// A stage of one evening.
class StageBench {
public:
    StageBench();
    ~StageBench();
    StageBench(const StageBench&) = delete;
    StageBench& operator=(const StageBench&) = delete;

    Bench bench;
    emulators::EmulatedDaq daq;
    /// Empty: nothing fails. Of the USB calls of both devices, and of the display's.
    Spoils spoils;
    /// The order gets through and its answer is lost.
    bool afterEffect = false;
    bool boardUnplugged = false, lensesUnplugged = false;
    /// Pulls the video cable at the computer's end, and puts it back.
    void unplugDisplay();
    void plugDisplay();
    /// Pulls the box's cable: it loses its power. The board has its own and goes on.
    void unplugLenses();
    /// Why the projector cannot be opened, as the bus says it.
    std::optional<Error> boardRefusal;
    std::unique_ptr<LightCrafterStage> stage;
    /// A new one, as a restarted player has it.
    void opened() { stage = std::make_unique<LightCrafterStage>(made()); }

    Result<void> played(const Program& program) {
        return stage->load(program).and_then([&] { return stage->swap(); });
    }
    /// As the player does: a heartbeat each 100 ms, safe light asked for after each that fails. The first error.
    std::optional<std::string> beats(int count);
    DeviceLine line(const std::string& what) const;

    /// No pattern runs and the board shows white of its own, or the video is white; or every slot of the newest sweep
    /// is white.
    bool white();
    /// Both outputs hold the resting currents and nothing sweeps.
    bool lensesRest();
    double seconds() const { return 1e-9 * static_cast<double>(bench.now_ns()); }

private:
    class Display;
    template <class Link>
    class Spoilt;
    LightCrafterRig made();
    Clock clock();

    emulators::TriggerWire wire_{bench.board};
    bool displayUnplugged_ = false;
    std::shared_ptr<Display> display_;
    DaqLink* daqLink_ = nullptr;
};

/// A program for both eyes that the converter can play and the board can show; `seed` tells pictures apart.
Program evening(std::uint32_t seed);

}  // namespace ilf::devices::test
