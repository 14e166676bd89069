// The messages between studio, output core and devices, as values.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/compile/program.h"
#include "devices/stage.h"

namespace ilf::devices {

/// Why a program is sent. Only a take ends safe light; a live update is refused while safe light is held.
enum class Why { live, take };

/// A rectangle of a tile.
struct TilePart {
    int x = 0, y = 0, width = kTile, height = kTile;
    bool operator==(const TilePart&) const = default;
    bool isWhole() const { return width == kTile && height == kTile; }
};

/// One tile of one image that differs from the base: only within `part`, and only that travels; 0 beside it.
struct TileUpdate {
    int image = 0, column = 0, row = 0;
    Box<Tile> tile;
    TilePart part{};
    bool operator==(const TileUpdate&) const = default;
};

/// A program as its differences from another one, which the receiver already has.
struct ProgramUpdate {
    std::uint64_t revision = 0;
    Why why = Why::live;
    std::uint64_t hold = 0;  ///< the hold (Status::hold) that the sender knows of; a take ends that one and no other
    std::optional<std::uint64_t> base;  ///< content hash of the program it differs from; none: from black images
    std::uint64_t hash = 0;             ///< content hash of the whole program
    Waveform waveform;
    Hertz slotRate;
    Second projectorDelay;
    Size projector;
    int images = 0;
    std::vector<int> imageOfSlot;
    std::vector<TileUpdate> tiles;
    bool operator==(const ProgramUpdate&) const = default;
};

/// The first word of every client, said again every 100 ms so that the other end knows it is there.
struct Hello {
    std::string role;
    bool operator==(const Hello&) const = default;
};

/// The update arrived whole; later updates may use it as their base.
struct Ack {
    std::uint64_t revision = 0, hash = 0;
    bool operator==(const Ack&) const = default;
};

struct Refused {
    Error error;
    bool sendWhole = false;  ///< the base is unknown here: the same program sent whole would be taken
    bool operator==(const Refused&) const = default;
};

struct SafeLight {
    bool operator==(const SafeLight&) const = default;
};

/// What the output core says of itself. Times are of CLOCK_MONOTONIC, in nanoseconds, 0: not yet.
struct Status {
    bool connected = false;  ///< said by the client's end: the core answered within the last 500 ms
    LightMode light = LightMode::steady;
    std::uint64_t hold = 0;  ///< not 0: safe light is held until a take names this number
    std::uint64_t revisionPlayed = 0, contentHashPlayed = 0;
    std::uint64_t swaps = 0, droppedUpdates = 0;
    std::int64_t received_ns = 0, loaded_ns = 0, swapped_ns = 0;  ///< of the last program put on show
    LensMode lens = LensMode::rest;
    Dioptre lensPower, low, high;
    std::string projectorLine, lensLine;  ///< one line each: name and state
    bool projectorWell = false, lensWell = false;
    std::string fault;         ///< the last fault; stays until a take
    std::uint64_t faults = 0;  ///< how many there were
    int pid = 0, supervisorPid = 0;
    bool simulated = true;
    std::string lensName;     ///< "simulated lens, preset datasheet": whose calibration plans need
    std::string lastRefusal;  ///< why the last update was not taken; empty once one is
    // As in StageReport, and what the core may and may not do on this machine.
    bool emulated = false;
    std::optional<StageTiming> timing;
    std::optional<double> lensTemperature_C;
    std::vector<DeviceLine> devices;
    std::vector<std::string> limits;  ///< "Real-time priority is not allowed: ...", one sentence each
    bool operator==(const Status&) const = default;
};

// To the devices.
struct SetWaveform {
    Waveform waveform;
    bool operator==(const SetWaveform&) const = default;
};
struct SetSlotRate {
    Hertz rate;
    bool operator==(const SetSlotRate&) const = default;
};
struct Swap {
    bool operator==(const Swap&) const = default;
};
struct SteadyLight {
    bool operator==(const SteadyLight&) const = default;
};
struct LensToRest {
    bool operator==(const LensToRest&) const = default;
};
struct Read {
    bool operator==(const Read&) const = default;
};
struct ReadSlot {
    int slot = 0;
    bool operator==(const ReadSlot&) const = default;
};
/// For tests. The first lets a later call fail: `refuse` answers with an error, `silence` answers nothing from then on,
/// `die` ends the process. The others befall lens and projector at once: `warmer` by 10 C, a `drift` of the lens's
/// clock of 100 ppm against the projector's, one `dropTrigger` that the projector does not get. `none` ends them all.
struct InjectFault {
    enum class Kind { none, refuse, silence, die, warmer, drift, dropTrigger };
    Kind kind = Kind::none;
    std::uint32_t afterCalls = 0;  ///< 0: the next command
    bool operator==(const InjectFault&) const = default;
};

// From the devices.
struct Done {
    std::int64_t at_ns = 0;  ///< when it happens; for a swap the start of the sweep it begins with
    bool operator==(const Done&) const = default;
};
struct SlotImage {
    int slot = 0;
    LightImage image;
    std::uint64_t hash = 0;
    bool operator==(const SlotImage&) const = default;
};

/// What lens and projector really do. `powerNow` and `lensError` are of the moment `now_ns`.
struct DeviceState {
    std::int64_t now_ns = 0;
    LightMode light = LightMode::steady;
    Hertz slotRate;
    std::uint64_t hashShown = 0;   ///< 0 in steady light
    std::uint64_t hashLoaded = 0;  ///< in the back buffer; 0: nothing
    std::vector<std::uint64_t> slotHashes;
    std::uint64_t swaps = 0;
    std::int64_t swapped_ns = 0;
    LensMode lens = LensMode::rest;
    Waveform waveform;
    Dioptre powerNow;
    Dioptre lensError;     ///< the largest that the lens still settles by: how far from repeating its wave
    std::string lensName;  ///< "simulated lens, preset datasheet"
    Dioptre offWave;       ///< rms over the last sweep, power against the wave's prediction; 0 until settled
    double lensTemperature_C = 30.0;
    Second phaseError;               ///< how late slots are against the lens's sweep
    std::uint64_t triggersLost = 0;  ///< since slots came on
    std::uint64_t rateChangesUnderSlottedLight = 0;
    std::uint64_t waveformChangesUnderSlottedLight = 0;
    std::uint64_t refusals = 0, watchdogTrips = 0, calls = 0, tilesReceived = 0;
    int pid = 0;
    std::vector<std::string> log;  ///< the last commands, oldest first
    bool operator==(const DeviceState&) const = default;
};

// To and from an emulated rig (devices/emulated_rig): what its cables brought.
/// Takes hold of the newest whole sweep; ReadExposure then asks for its light.
struct ReadReceived {
    bool operator==(const ReadReceived&) const = default;
};
struct ReadExposure {
    int number = 0;  ///< of Received::exposures
    bool operator==(const ReadExposure&) const = default;
};
/// One exposure of the projector, as long as its lamp was steady. Times count from the sweep's trigger.
struct Exposure {
    Second start, length;
    int bits = 8;
    unsigned colours = 7;  ///< of the lamp: red 1, green 2, blue 4
    bool video = false;    ///< plain video: a whole frame
    bool operator==(const Exposure&) const = default;
};
struct Received {
    std::int64_t trigger_ns = 0;  ///< the sweep's, in CLOCK_MONOTONIC
    Second sweep;                 ///< from this trigger to the next
    Size raster;                  ///< of the exposures
    std::vector<Exposure> exposures;
    std::vector<Dioptre> left, right;  ///< the lenses' powers, evenly from the trigger over the sweep
    std::array<double, 2> temperature_C{30.0, 30.0};
    std::array<double, 2> most_mA{0.0, 0.0};  ///< the greatest current of the sweep, either direction
    bool patterns = false;                    ///< the projector shows patterns, not video
    bool harmed = false;                      ///< something came in that would hurt a projector
    int ledCurrentWrites = 0;
    std::uint64_t frames = 0, triggers = 0, transfers = 0;  ///< since the rig was switched on
    std::vector<std::string> log;                           ///< what befell it, oldest first
    bool operator==(const Received&) const = default;
};
/// Answers ReadExposure.
struct ExposedLight {
    int number = 0;
    Size raster;
    std::vector<std::uint8_t> light;  ///< linear, 255 = full, row by row
    bool operator==(const ExposedLight&) const = default;
};
/// Lets something go wrong, by the words of devices/emulators/fault.h: device "projector" or "lenses"; kind "nack",
/// "silence", "stall", "unplug", "wrong-mode", "underrun", "over-temperature", "dropped-trigger", "clock-drift",
/// "stuck-frame"; "plug" puts the cable back, "none" ends all; "power-cycle" (projector); of "display" "unplug",
/// "plug".
struct RigMishap {
    std::string device, kind;
    std::uint64_t after = 0, times = 0;  ///< times 0: from then on for ever
    double amount = 0.0;
    bool operator==(const RigMishap&) const = default;
};

using Body = std::variant<Hello, ProgramUpdate, Ack, Refused, SafeLight, Status, SetWaveform, SetSlotRate, Swap,
                          SteadyLight, LensToRest, Read, ReadSlot, InjectFault, Done, SlotImage, DeviceState,
                          ReadReceived, ReadExposure, Received, ExposedLight, RigMishap>;

/// An answer carries the id of the question; messages that answer nothing carry 0.
struct Message {
    std::uint64_t id = 0;
    Body body;
    bool operator==(const Message&) const = default;
};

}  // namespace ilf::devices
