#include "tests/devices/endtoend/stage_bench.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "devices/rig/pattern_frames.h"
#include "devices/rig/usb1208_lens.h"

namespace ilf::devices::test {

using emulators::UsbAnswer;

// ---- the converter's cable

struct DaqLink::Out final : UsbStream {
    DaqLink& link;
    std::function<void(std::span<std::uint8_t>)> fill;
    std::deque<Bytes> queued;
    std::optional<UsbAnswer> ended;

    Out(DaqLink& owner, std::size_t bytes, int inFlight, std::function<void(std::span<std::uint8_t>)> with)
        : link(owner), fill(std::move(with)) {
        for (int i = 0; i < inFlight; ++i) {
            queued.emplace_back(bytes);
            fill(queued.back());
        }
        link.out_ = this;
    }
    ~Out() override { link.out_ = nullptr; }
    Result<void> state() const override { return ended ? failed(*ended) : Result<void>(); }
    void pump() {
        while (!ended && !queued.empty()) {
            Bytes& first = queued.front();
            const std::size_t whole = first.size();
            const auto moved = link.daq_.out(0x02, first, link.bench_.now_ns());
            first.erase(first.begin(), first.begin() + static_cast<std::ptrdiff_t>(moved.bytes));
            const auto answer = link.noticed(moved.answer);
            if (answer == UsbAnswer::busy) return;
            if (answer != UsbAnswer::done) {
                ended = answer;
                return;
            }
            Bytes next(std::max(whole, size));
            size = next.size();
            queued.pop_front();
            fill(next);
            queued.push_back(std::move(next));
        }
    }
    std::size_t size = 0;
};

struct DaqLink::In final : UsbStream {
    DaqLink& link;
    std::function<void(std::span<const std::uint8_t>)> taken;
    Bytes room;
    std::size_t filled = 0;
    std::optional<UsbAnswer> ended;

    In(DaqLink& owner, std::size_t bytes, std::function<void(std::span<const std::uint8_t>)> by)
        : link(owner), taken(std::move(by)), room(bytes) {
        link.in_ = this;
    }
    ~In() override { link.in_ = nullptr; }
    Result<void> state() const override { return ended ? failed(*ended) : Result<void>(); }
    void pump() {
        while (!ended) {
            const auto moved = link.daq_.in(0x81, std::span(room).subspan(filled), link.bench_.now_ns());
            filled += moved.bytes;
            const auto answer = link.noticed(moved.answer);
            if (answer == UsbAnswer::stall || answer == UsbAnswer::gone) ended = answer;
            if (filled < room.size()) return;
            taken(room);
            filled = 0;
        }
    }
};

tl::unexpected<Error> DaqLink::failed(UsbAnswer answer) {
    return fail(Fault::device, answer == UsbAnswer::gone    ? "USB-1208FS-Plus at 1-3 is gone. Plug it in again."
                               : answer == UsbAnswer::stall ? "USB-1208FS-Plus at 1-3 refused (stalled)."
                                                            : "USB-1208FS-Plus at 1-3 did not answer in time.");
}

/// What is gone stays gone, whatever the box would say to what is asked next.
UsbAnswer DaqLink::noticed(UsbAnswer answer) {
    gone_ = gone_ || answer == UsbAnswer::gone;
    return gone_ ? UsbAnswer::gone : answer;
}

void DaqLink::pump() {
    if (out_ != nullptr) out_->pump();
    if (in_ != nullptr) in_->pump();
}

void DaqLink::pulled() {
    if (out_ != nullptr) out_->ended = UsbAnswer::gone;
    if (in_ != nullptr) in_->ended = UsbAnswer::gone;
}

Result<std::size_t> DaqLink::control(std::uint8_t type, const VendorRequest& r, std::span<std::uint8_t> data) {
    bench_.advance(250'000);
    const auto length = static_cast<std::uint16_t>(data.size());
    const auto moved = daq_.control({type, r.request, r.value, r.index, length}, data, bench_.now_ns());
    if (const auto answer = noticed(moved.answer); answer != UsbAnswer::done) return failed(answer);
    return moved.bytes;
}

Result<void> DaqLink::controlOut(const VendorRequest& request, std::span<const std::uint8_t> data, Milliseconds limit) {
    Bytes copy(data.begin(), data.end());
    const auto done = control(0x40, request, copy);
    if (done) return {};
    bench_.advance(std::chrono::nanoseconds(limit).count());
    return tl::unexpected(done.error());
}

Result<Bytes> DaqLink::controlIn(const VendorRequest& request, std::size_t length, Milliseconds limit) {
    Bytes room(length);
    const auto done = control(0xC0, request, room);
    if (!done) {
        bench_.advance(std::chrono::nanoseconds(limit).count());
        return tl::unexpected(done.error());
    }
    room.resize(*done);
    return room;
}

Result<void> DaqLink::clearHalt(Endpoint endpoint) {
    daq_.clearHalt(endpoint.address, bench_.now_ns());
    return {};
}

Result<std::unique_ptr<UsbStream>> DaqLink::streamOut(Endpoint, std::size_t bytes, int inFlight,
                                                      std::function<void(std::span<std::uint8_t>)> fill) {
    auto stream = std::make_unique<Out>(*this, bytes, inFlight, std::move(fill));
    stream->size = bytes;
    stream->pump();
    return stream;
}

Result<std::unique_ptr<UsbStream>> DaqLink::streamIn(Endpoint, std::size_t bytes, int,
                                                     std::function<void(std::span<const std::uint8_t>)> taken) {
    return std::make_unique<In>(*this, bytes, std::move(taken));
}

// ---- cables and display that fail when asked to

/// A cable some of whose calls fail, before or after they had their effect.
template <class Link>
class StageBench::Spoilt final : public UsbLink {
public:
    template <class... Arguments>
    Spoilt(StageBench& owner, const bool& unplugged, Arguments&&... arguments)
        : link(std::forward<Arguments>(arguments)...), owner_(owner), unplugged_(unplugged) {}
    const UsbIdentity& identity() const override { return link.identity(); }
    Result<Endpoint> interruptOut() const override { return link.interruptOut(); }
    Result<Endpoint> interruptIn() const override { return link.interruptIn(); }
    Result<Endpoint> bulkOut() const override { return link.bulkOut(); }
    Result<Endpoint> bulkIn() const override { return link.bulkIn(); }
    Result<void> send(Endpoint to, std::span<const std::uint8_t> data, Milliseconds limit) override {
        return spoilt([&] { return link.send(to, data, limit); });
    }
    Result<Bytes> receive(Endpoint from, std::size_t most, Milliseconds limit) override {
        return spoilt([&] { return link.receive(from, most, limit); });
    }
    Result<void> controlOut(const VendorRequest& request, std::span<const std::uint8_t> data,
                            Milliseconds limit) override {
        return spoilt([&] { return link.controlOut(request, data, limit); });
    }
    Result<Bytes> controlIn(const VendorRequest& request, std::size_t length, Milliseconds limit) override {
        return spoilt([&] { return link.controlIn(request, length, limit); });
    }
    Result<void> clearHalt(Endpoint endpoint) override {
        return spoilt([&] { return link.clearHalt(endpoint); });
    }
    Result<std::unique_ptr<UsbStream>> streamOut(Endpoint to, std::size_t bytes, int inFlight,
                                                 std::function<void(std::span<std::uint8_t>)> fill) override {
        return spoilt([&] { return link.streamOut(to, bytes, inFlight, std::move(fill)); });
    }
    Result<std::unique_ptr<UsbStream>> streamIn(Endpoint from, std::size_t bytes, int inFlight,
                                                std::function<void(std::span<const std::uint8_t>)> taken) override {
        return spoilt([&] { return link.streamIn(from, bytes, inFlight, std::move(taken)); });
    }

    Link link;

private:
    template <class Call>
    std::invoke_result_t<Call> spoilt(Call call) {
        if (unplugged_) return fail(Fault::device, identity().productName + " is gone. Plug it in again.");
        const bool failing = owner_.spoils && owner_.spoils();
        auto done = !failing || owner_.afterEffect ? call() : std::invoke_result_t<Call>(spoiltError());
        return failing ? std::invoke_result_t<Call>(spoiltError()) : std::move(done);
    }
    tl::unexpected<Error> spoiltError() const {
        return fail(Fault::device, identity().productName + " failed because the test wants it.");
    }
    StageBench& owner_;
    const bool& unplugged_;
};

class StageBench::Display final : public VideoOutput {
public:
    explicit Display(StageBench& owner) : owner_(owner) {}
    Result<ScannedOut> show(const VideoFrame& frame) override {
        if (owner_.displayUnplugged_) return gone();
        const bool failing = owner_.spoils && owner_.spoils();
        if (failing && !owner_.afterEffect) return spoilt();
        if (shown != frame) {  // white is shown over and over, and copying it takes longer than all else
            shown = frame;
            owner_.bench.present({frame.size(), {frame.pixels().begin(), frame.pixels().end()}});
        }
        const std::int64_t now = owner_.bench.now_ns(), frames = now / Bench::kFrame_ns + 1;
        owner_.bench.advance(frames * Bench::kFrame_ns - now);
        if (failing) return spoilt();
        return ScannedOut{std::chrono::nanoseconds(owner_.bench.now_ns()), frames};
    }
    Result<VideoMode> mode() override {
        if (owner_.displayUnplugged_) return gone();
        if (owner_.spoils && owner_.spoils()) return spoilt();
        return VideoMode{{912, 1140}, 60.0_Hz};
    }
    const DisplayIdentity& display() const override { return identity_; }
    VideoFrame shown;

private:
    static tl::unexpected<Error> gone() {
        return fail(Fault::device, "The projector's display (HDMI-2) is gone. Check its cable and its power.");
    }
    static tl::unexpected<Error> spoilt() {
        return fail(Fault::device, "The display failed because the test wants it.");
    }
    StageBench& owner_;
    DisplayIdentity identity_{"HDMI-2", "TXN", "DLPC350", ""};
};

// ---- the evening

namespace {

/// Packing takes longer than playing, and the same few programs are played over and over.
Result<PatternFrame> remembered(const Program& program) {
    static std::vector<std::pair<Program, PatternFrame>> known;
    for (const auto& [packed, frame] : known)
        if (packed.images.front() == program.images.front() && packed.imageOfSlot == program.imageOfSlot) return frame;
    return patternFrames(1)(program).map([&](PatternFrame frame) {
        known.emplace_back(program, frame);
        return frame;
    });
}

}  // namespace

StageBench::StageBench() {
    connect(daq, 0, wire_, bench.board, [this](int channel, std::int64_t time_ns) {
        return channel == 1 ? emulators::EmulatedDaq::volts(daq.outputsAt(time_ns).codes[0]) : 0.0;
    });
    bench.meanwhile = [this] {
        if (daqLink_ != nullptr) daqLink_->pump();
    };
    bench.frames(20);
    display_ = std::make_shared<Display>(*this);
    opened();
}

StageBench::~StageBench() { stage.reset(); }

LightCrafterRig StageBench::made() {
    LightCrafterRig rig;
    rig.openProjector = [this]() -> Result<std::unique_ptr<StageProjector>> {
        if (boardUnplugged)
            return fail(Fault::notFound, "No USB device is plugged in at 1-2. Plug it in at that port.");
        if (boardRefusal) return tl::unexpected(*boardRefusal);
        auto link = std::make_unique<Spoilt<DirectLink>>(*this, boardUnplugged, bench);
        auto board = dlpc350::LightCrafter::open(std::move(link), bench.clock());
        if (!board) return tl::unexpected(board.error());
        return std::make_unique<LightCrafterProjector>(*std::move(board));
    };
    rig.openLens = [this](Dioptre rest) -> Result<std::unique_ptr<StageLens>> {
        if (lensesUnplugged)
            return fail(Fault::notFound, "No USB device is plugged in at 1-3. Plug it in at that port.");
        auto link = std::make_shared<Spoilt<DaqLink>>(*this, lensesUnplugged, bench, daq, daqLink_);
        return Usb1208Lens::open(std::move(link), {}, rest, bench.clock());
    };
    rig.video = display_;
    rig.packed = remembered;
    rig.clock = bench.clock();
    return rig;
}

void StageBench::unplugLenses() {
    lensesUnplugged = true;
    daq.unplugged(bench.now_ns());
    if (daqLink_ != nullptr) daqLink_->pulled();
}

void StageBench::unplugDisplay() {
    displayUnplugged_ = true;
    bench.board.unplugVideo(bench.now_ns());
}

void StageBench::plugDisplay() {
    displayUnplugged_ = false;
    bench.board.plugVideo({912, 1140, 60.0}, bench.now_ns());
}

std::optional<std::string> StageBench::beats(int count) {
    std::optional<std::string> first;
    for (int i = 0; i < count; ++i) {
        bench.advance(100'000'000);
        const auto beat = stage->heartbeat();
        if (beat) continue;
        if (!first) first = beat.error().what;
        stage->safeLight();
    }
    return first;
}

DeviceLine StageBench::line(const std::string& what) const {
    for (const auto& line : stage->report().devices)
        if (line.what == what) return line;
    return {};
}

bool StageBench::white() {
    const auto full = [](const SlotLight& slot) {
        return std::ranges::all_of(slot.light.pixels(), [](std::uint8_t value) { return value == 255; });
    };
    if (bench.board.draws(bench.now_ns())) {
        (void)bench.takeLight();
        bench.frames(2);
        const auto light = bench.takeLight();
        return !light.empty() && full(taken(light.back(), 0));
    }
    if (!bench.board.running()) return !displayUnplugged_ && display_->shown == uniformFrame({912, 1140}, 255);
    const auto sweep = bench.newestSweep();
    return !sweep.empty() && std::ranges::all_of(sweep, full);
}

bool StageBench::lensesRest() {
    constexpr int kRunning = 0x08;
    const auto outputs = daq.outputs(bench.now_ns());
    return (daq.status(bench.now_ns()) & kRunning) == 0 && std::abs(int(outputs.codes[0]) - 2048) <= 1 &&
           std::abs(int(outputs.codes[1]) - 2048) <= 1;
}

Program evening(std::uint32_t seed) {
    Program program = sweepOf(24, seed);
    program.waveform.unit = DriveUnit::ampere;
    program.waveform.drive.c = {0.0, 0.15};
    return program;
}

}  // namespace ilf::devices::test
