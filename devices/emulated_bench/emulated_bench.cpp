#include "devices/emulated_bench/emulated_bench.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ilf::devices {
namespace {

constexpr double kConverterRate_Hz = 48000.0;
constexpr std::int64_t kStep_ns = 500'000;  // how often the bus looks at the converter
constexpr std::int64_t kRemembered_ns = 200'000'000;
constexpr double kLogic_V = 3.3, kPulse_s = 0.0005;

using emulators::UsbAnswer;

class BenchLink : public UsbLink {
public:
    explicit BenchLink(EmulatedBench& bench) : bench_(bench) {}

    const UsbIdentity& identity() const override { return identity_; }
    Result<Endpoint> interruptOut() const override { return gone(); }
    Result<Endpoint> interruptIn() const override { return gone(); }
    Result<Endpoint> bulkOut() const override {
        if (bench_.failing()) return gone();
        return Endpoint{0x02};
    }
    Result<Endpoint> bulkIn() const override {
        if (bench_.failing()) return gone();
        return Endpoint{0x81};
    }
    Result<void> send(Endpoint, std::span<const std::uint8_t>, Milliseconds) override { return gone(); }
    Result<Bytes> receive(Endpoint, std::size_t, Milliseconds) override { return gone(); }
    Result<void> controlOut(const VendorRequest& r, std::span<const std::uint8_t> data, Milliseconds) override {
        Bytes sent(data.begin(), data.end());
        return control(0x40, r, sent);
    }
    Result<Bytes> controlIn(const VendorRequest& r, std::size_t length, Milliseconds) override {
        Bytes room(length);
        if (auto done = control(0xC0, r, room); !done) return tl::unexpected(done.error());
        return room;
    }
    Result<void> clearHalt(Endpoint endpoint) override {
        if (bench_.failing()) return gone();
        bench_.daq.clearHalt(endpoint.address, bench_.now_ns());
        return {};
    }
    Result<std::unique_ptr<UsbStream>> streamOut(Endpoint, std::size_t bytes, int inFlight,
                                                 std::function<void(std::span<std::uint8_t>)> fill) override {
        if (bench_.failing()) return gone();
        auto stream = std::make_unique<OutStream>(bench_);
        stream->out.fill = std::move(fill);
        for (int i = 0; i < inFlight; ++i) {
            stream->out.queued.emplace_back(bytes);
            stream->out.fill(stream->out.queued.back());
        }
        stream->out.bytes = bytes;
        bench_.out = &stream->out;
        bench_.pass(std::chrono::nanoseconds(kStep_ns));
        return stream;
    }
    Result<std::unique_ptr<UsbStream>> streamIn(Endpoint, std::size_t bytes, int,
                                                std::function<void(std::span<const std::uint8_t>)> taken) override {
        if (bench_.failing()) return gone();
        auto stream = std::make_unique<InStream>(bench_);
        stream->in.taken = std::move(taken);
        stream->in.room.resize(bytes);
        bench_.in = &stream->in;
        return stream;
    }

private:
    struct OutStream final : UsbStream {
        explicit OutStream(EmulatedBench& of) : bench(of) {}
        ~OutStream() override { bench.out = nullptr; }
        Result<void> state() const override { return bench.unplugged ? gone() : Result<void>(); }
        EmulatedBench& bench;
        EmulatedBench::Out out;
    };
    struct InStream final : UsbStream {
        explicit InStream(EmulatedBench& of) : bench(of) {}
        ~InStream() override { bench.in = nullptr; }
        Result<void> state() const override { return bench.unplugged ? gone() : Result<void>(); }
        EmulatedBench& bench;
        EmulatedBench::In in;
    };

    static tl::unexpected<Error> gone() {
        return fail(Fault::device, "The USB-1208FS-Plus at 1-3 is gone. Plug it in again.");
    }
    Result<void> control(std::uint8_t type, const VendorRequest& r, Bytes& data) {
        if (bench_.failing()) return gone();
        bench_.pass(std::chrono::microseconds(250));
        const auto length = static_cast<std::uint16_t>(data.size());
        const auto done = bench_.daq.control({type, r.request, r.value, r.index, length}, data, bench_.now_ns());
        if (done.answer != UsbAnswer::done) return fail(Fault::device, "The USB-1208FS-Plus refused a request.");
        return {};
    }

    EmulatedBench& bench_;
    UsbIdentity identity_{0x09DB, 0x00E8, "1-3", "USB-1208FS-Plus", "emulated"};
};

double clockSeconds(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }

}  // namespace

double EmulatedPhotodiode::volts(double power_D) const {
    if (!lit) return dark_V;
    const double radius = beam_m * std::abs(1.0 - behind_m * power_D);
    return dark_V + full_V * (1.0 - std::exp(-2.0 * cell_m * cell_m / std::max(1e-12, radius * radius)));
}

EmulatedBench::EmulatedBench(LensPreset preset, double room_C)
    : lenses{LensEmulator(lensParameters(preset, 11), room_C), LensEmulator(lensParameters(preset, 12), room_C)},
      preset_(preset) {
    daq.setInput([this](int channel, std::int64_t time_ns) { return input(channel, time_ns); },
                 [this](std::int64_t) { return simulated_ns_; });
}

bool EmulatedBench::failing() {
    ++calls;
    const bool now = failsAt != 0 && (calls == failsAt || (goesAway && calls > failsAt));
    if (now && goesAway) unplugged = true;
    return now || unplugged;
}

Clock EmulatedBench::clock() {
    return {[this] { return std::chrono::nanoseconds(now_ns_); },
            [this](std::chrono::nanoseconds time) { pass(time); }};
}

std::shared_ptr<UsbLink> EmulatedBench::link() { return std::make_shared<BenchLink>(*this); }

void EmulatedBench::pass(std::chrono::nanoseconds time) {
    for (std::int64_t left = time.count(); left > 0; left -= kStep_ns) {
        now_ns_ += std::min(left, kStep_ns);
        if (!unplugged) pump();
        simulate();
        if (!unplugged) pump();
    }
}

void EmulatedBench::pump() {
    while (out != nullptr && !out->queued.empty()) {
        auto& first = out->queued.front();
        const auto sent = daq.out(0x02, first, now_ns_);
        first.erase(first.begin(), first.begin() + static_cast<std::ptrdiff_t>(sent.bytes));
        if (sent.answer != UsbAnswer::done) break;
        out->queued.erase(out->queued.begin());
        out->queued.emplace_back(out->bytes);
        out->fill(out->queued.back());
    }
    while (in != nullptr) {
        const auto got = daq.in(0x81, std::span(in->room).subspan(in->filled), now_ns_);
        in->filled += got.bytes;
        if (in->filled < in->room.size()) break;
        in->filled = 0;
        in->taken(in->room);
    }
}

void EmulatedBench::simulate() {
    const auto played = daq.takeOutput(now_ns_);
    std::size_t next = 0;
    const auto tick = static_cast<std::int64_t>(1e9 / kConverterRate_Hz);
    while (simulated_ns_ < now_ns_) {
        for (; next < played.size() && played[next].time_ns <= simulated_ns_; ++next) {
            for (std::size_t eye = 0; eye < 2; ++eye) {
                const double current_A = 1e-3 * daq.current_mA(played[next], static_cast<int>(eye));
                if (current_A == driven_A_[eye]) continue;
                driven_A_[eye] = current_A;
                largest_A = std::max(largest_A, std::abs(current_A));
                const double amplifier_A_per_V = lensParameters(preset_, 11 + eye).amplifier_A_per_V;
                lenses[eye].play(Harmonics{{lensPlugged[eye] ? current_A / amplifier_A_per_V : 0.0}}, 60.0_Hz);
            }
        }
        // As far as the outputs stay as they are.
        std::int64_t until = std::min(now_ns_, simulated_ns_ + tick);
        if (next < played.size()) until = std::min(until, played[next].time_ns);
        for (LensEmulator& lens : lenses)
            lens.advance(Second::fromSi(clockSeconds(until - simulated_ns_)));
        simulated_ns_ = until;
        past_.push_back({until, {lenses[0].power().si(), lenses[1].power().si()}});
    }
    while (past_.size() > 2 && past_.front().time_ns < now_ns_ - kRemembered_ns)
        past_.pop_front();
}

double EmulatedBench::input(int channel, std::int64_t time_ns) {
    const auto output = [&](std::size_t eye) {
        return emulators::EmulatedDaq::volts(daq.outputsAt(time_ns).codes[eye]);
    };
    switch (channel == 0 ? ai0 : ai1) {
    case Heard::nothing:
        return 0.003 * normal_(random_);
    case Heard::left:
        return output(0) + 0.003 * normal_(random_);
    case Heard::right:
        return output(1) + 0.003 * normal_(random_);
    case Heard::trigger:
        return std::fmod(clockSeconds(time_ns), triggerEvery_s) < kPulse_s ? kLogic_V : 0.0;
    case Heard::photodiode:
        break;
    }
    double bright = photodiode.dark_V;
    if (projectorLight) {
        bright += projectorLight(std::fmod(clockSeconds(time_ns), triggerEvery_s));
    } else if (!past_.empty()) {
        const auto after = std::lower_bound(past_.begin(), past_.end(), time_ns,
                                            [](const Point& point, std::int64_t t) { return point.time_ns < t; });
        const Point& b = after == past_.end() ? past_.back() : *after;
        const Point& a = after == past_.begin() ? b : *std::prev(after);
        const double span = static_cast<double>(b.time_ns - a.time_ns);
        const double share = span > 0.0 ? std::clamp(static_cast<double>(time_ns - a.time_ns) / span, 0.0, 1.0) : 1.0;
        const auto eye = static_cast<std::size_t>(lensInBeam);
        bright = photodiode.volts(a.power_D[eye] + share * (b.power_D[eye] - a.power_D[eye]));
    }
    const double age_s = std::max(0.0, clockSeconds(time_ns - seenAt_ns_));
    seen_V_ += (bright - seen_V_) * (photodiode.slow_s > 0.0 ? 1.0 - std::exp(-age_s / photodiode.slow_s) : 1.0);
    seenAt_ns_ = time_ns;
    return seen_V_ + photodiode.noise_V * normal_(random_);
}

std::vector<double> EmulatedBench::truth(int lens, const Harmonics& drive_A, Hertz rate, int n) const {
    LensEmulator copy = lenses[static_cast<std::size_t>(lens)];
    const double amplifier_A_per_V = lensParameters(preset_, 11 + static_cast<std::uint64_t>(lens)).amplifier_A_per_V;
    Harmonics volts = drive_A;
    for (auto& c : volts.c)
        c /= amplifier_A_per_V;
    copy.play(volts, rate);
    const double period_s = 1.0 / rate.si();
    copy.advance(Second::fromSi(std::ceil(0.6 / period_s) * period_s));
    std::vector<double> powers;
    for (int i = 0; i < n; ++i) {
        powers.push_back(copy.power().si());
        copy.advance(Second::fromSi(period_s / n));
    }
    return powers;
}

double EmulatedBench::truthAtRest(int lens, double current_A) const {
    double sum = 0.0;
    for (const double from_A : {-0.02, 0.02}) {
        LensEmulator copy = lenses[static_cast<std::size_t>(lens)];
        const double amplifier_A_per_V =
            lensParameters(preset_, 11 + static_cast<std::uint64_t>(lens)).amplifier_A_per_V;
        for (const double current : {current_A + from_A, current_A}) {
            copy.play(Harmonics{{current / amplifier_A_per_V}}, 60.0_Hz);
            copy.advance(Second::fromSi(0.6));
        }
        sum += copy.power().si();
    }
    return 0.5 * sum;
}

std::array<double, 2> EmulatedBench::currents() {
    const auto now = daq.outputs(now_ns_);
    return {1e-3 * daq.current_mA(now, 0), 1e-3 * daq.current_mA(now, 1)};
}

}  // namespace ilf::devices
