#include "devices/link/codec.h"

#include "devices/link/program_update.h"
#include "tests/devices/programs.h"
#include "tests/support/fuzz.h"
#include "tests/support/law.h"

namespace ilf::devices {
namespace {

std::string anyText() { return *rc::gen::string<std::string>(); }
double anyNumber() {
    return *rc::gen::map(rc::gen::arbitrary<int>(), [](int n) { return n / 1024.0; });
}
std::uint64_t anyWord() { return *rc::gen::arbitrary<std::uint64_t>(); }
Dioptre anyPower() { return Dioptre::fromSi(anyNumber()); }
Harmonics anyHarmonics() {
    Harmonics f;
    f.c.resize(*rc::gen::inRange<std::size_t>(0, 6));
    for (auto& c : f.c)
        c = {anyNumber(), anyNumber()};
    return f;
}
Waveform anyWave() {
    Waveform wave;
    wave.mode = *rc::gen::element(WaveMode::idealSine, WaveMode::paper, WaveMode::shaped);
    wave.rest = anyPower();
    wave.low = anyPower();
    wave.high = anyPower();
    wave.rate = Hertz::fromSi(anyNumber());
    wave.power = anyHarmonics();
    wave.drive = anyHarmonics();
    wave.unit = *rc::gen::element(DriveUnit::volt, DriveUnit::ampere);
    wave.wave = *rc::gen::arbitrary<std::int64_t>();
    wave.provenance = *rc::gen::element(Provenance::simulated, Provenance::measured, Provenance::imported);
    wave.temperature_C = anyNumber();
    wave.warming_C = anyNumber();
    return wave;
}
LightMode anyLight() { return *rc::gen::element(LightMode::steady, LightMode::slotted); }
LensMode anyLens() { return *rc::gen::element(LensMode::rest, LensMode::holding, LensMode::sweeping); }

Status anyStatus() {
    Status s;
    s.light = anyLight();
    s.hold = anyWord();
    s.revisionPlayed = anyWord();
    s.contentHashPlayed = anyWord();
    s.swaps = anyWord();
    s.droppedUpdates = anyWord();
    s.received_ns = *rc::gen::arbitrary<std::int64_t>();
    s.loaded_ns = *rc::gen::arbitrary<std::int64_t>();
    s.swapped_ns = *rc::gen::arbitrary<std::int64_t>();
    s.lens = anyLens();
    s.lensPower = anyPower();
    s.low = anyPower();
    s.high = anyPower();
    s.projectorLine = anyText();
    s.lensLine = anyText();
    s.projectorWell = *rc::gen::arbitrary<bool>();
    s.lensWell = *rc::gen::arbitrary<bool>();
    s.fault = anyText();
    s.faults = anyWord();
    s.pid = *rc::gen::arbitrary<int>();
    s.supervisorPid = *rc::gen::arbitrary<int>();
    s.simulated = *rc::gen::arbitrary<bool>();
    s.lastRefusal = anyText();
    s.lensName = anyText();
    s.emulated = *rc::gen::arbitrary<bool>();
    if (*rc::gen::arbitrary<bool>())
        s.timing = StageTiming{*rc::gen::arbitrary<bool>(), Second::fromSi(anyNumber()), Second::fromSi(anyNumber()),
                               anyNumber(), anyWord()};
    if (*rc::gen::arbitrary<bool>()) s.lensTemperature_C = anyNumber();
    for (int i = *rc::gen::inRange(0, 4); i > 0; --i)
        s.devices.push_back(
            {anyText(), *rc::gen::element(DeviceHealth::well, DeviceHealth::silent), anyText(), anyText()});
    s.limits = *rc::gen::arbitrary<std::vector<std::string>>();
    return s;
}

Received anyReceived() {
    const auto side = [] { return *rc::gen::inRange(0, 2000); };
    const auto powers = [] { return *rc::gen::container<std::vector<Dioptre>>(rc::gen::exec(anyPower)); };
    Received r;
    r.trigger_ns = *rc::gen::arbitrary<std::int64_t>();
    r.sweep = Second::fromSi(anyNumber());
    r.raster = {side(), side()};
    for (int i = *rc::gen::inRange(0, 24); i > 0; --i)
        r.exposures.push_back({Second::fromSi(anyNumber()), Second::fromSi(anyNumber()), *rc::gen::inRange(1, 9),
                               *rc::gen::inRange(0U, 8U), *rc::gen::arbitrary<bool>()});
    r.left = powers();
    r.right = powers();
    r.temperature_C = {anyNumber(), anyNumber()};
    r.most_mA = {anyNumber(), anyNumber()};
    r.patterns = *rc::gen::arbitrary<bool>();
    r.harmed = *rc::gen::arbitrary<bool>();
    r.ledCurrentWrites = *rc::gen::arbitrary<int>();
    r.frames = anyWord();
    r.triggers = anyWord();
    r.transfers = anyWord();
    r.log = *rc::gen::arbitrary<std::vector<std::string>>();
    return r;
}

ExposedLight anyExposedLight() {
    const Size raster{*rc::gen::inRange(0, 50), *rc::gen::inRange(0, 50)};
    const auto pixels = static_cast<std::size_t>(raster.width) * static_cast<std::size_t>(raster.height);
    return {*rc::gen::inRange(0, 1000), raster,
            *rc::gen::container<std::vector<std::uint8_t>>(pixels, rc::gen::arbitrary<std::uint8_t>())};
}

DeviceState anyState() {
    DeviceState s;
    s.now_ns = *rc::gen::arbitrary<std::int64_t>();
    s.light = anyLight();
    s.slotRate = Hertz::fromSi(anyNumber());
    s.hashShown = anyWord();
    s.hashLoaded = anyWord();
    s.slotHashes = *rc::gen::arbitrary<std::vector<std::uint64_t>>();
    s.swaps = anyWord();
    s.swapped_ns = *rc::gen::arbitrary<std::int64_t>();
    s.lens = anyLens();
    s.waveform = anyWave();
    s.powerNow = anyPower();
    s.lensError = anyPower();
    s.rateChangesUnderSlottedLight = anyWord();
    s.waveformChangesUnderSlottedLight = anyWord();
    s.refusals = anyWord();
    s.watchdogTrips = anyWord();
    s.calls = anyWord();
    s.tilesReceived = anyWord();
    s.pid = *rc::gen::arbitrary<int>();
    s.lensName = anyText();
    s.offWave = anyPower();
    s.lensTemperature_C = anyNumber();
    s.phaseError = Second::fromSi(anyNumber());
    s.triggersLost = anyWord();
    s.log = *rc::gen::arbitrary<std::vector<std::string>>();
    return s;
}

ProgramUpdate anyUpdate() {
    const auto before = test::program(*rc::gen::inRange(0U, 50U));
    const auto after = test::program(*rc::gen::inRange(0U, 50U));
    auto update = *rc::gen::arbitrary<bool>() ? difference(after, contentHash(after))
                                              : difference(after, contentHash(after), &before, contentHash(before));
    update.revision = anyWord();
    update.why = *rc::gen::element(Why::live, Why::take);
    update.hold = anyWord();
    return update;
}

constexpr std::size_t kKinds = std::variant_size_v<Body>;

Message anyMessage(std::size_t kind) {
    const auto small = [] { return *rc::gen::inRange(0, 1000); };
    const std::uint64_t id = anyWord();
    switch (kind) {
    case 0:
        return {id, Hello{anyText()}};
    case 1:
        return {id, anyUpdate()};
    case 2:
        return {id, Ack{anyWord(), anyWord()}};
    case 3:
        return {id, Refused{{Fault::unsafe, anyText()}, *rc::gen::arbitrary<bool>()}};
    case 4:
        return {id, SafeLight{}};
    case 5:
        return {id, anyStatus()};
    case 6:
        return {id, SetWaveform{anyWave()}};
    case 7:
        return {id, SetSlotRate{Hertz::fromSi(anyNumber())}};
    case 8:
        return {id, Swap{}};
    case 9:
        return {id, SteadyLight{}};
    case 10:
        return {id, LensToRest{}};
    case 11:
        return {id, Read{}};
    case 12:
        return {id, ReadSlot{small()}};
    case 13:
        return {id, InjectFault{*rc::gen::element(InjectFault::Kind::silence, InjectFault::Kind::dropTrigger),
                                static_cast<std::uint32_t>(small())}};
    case 14:
        return {id, Done{*rc::gen::arbitrary<std::int64_t>()}};
    case 15:
        return {id, SlotImage{small(), test::picture({200, 130}, *rc::gen::inRange(0U, 50U)), anyWord()}};
    case 16:
        return {id, anyState()};
    case 17:
        return {id, ReadReceived{}};
    case 18:
        return {id, ReadExposure{small()}};
    case 19:
        return {id, anyReceived()};
    case 20:
        return {id, anyExposedLight()};
    default:
        return {id, RigMishap{anyText(), anyText(), anyWord(), anyWord(), anyNumber()}};
    }
}

}  // namespace

TEST_CASE("codec: every message comes back as it was sent") {
    for (std::size_t kind = 0; kind < kKinds; ++kind) {
        law("kind " + std::to_string(kind) + " survives the wire", [kind] {
            const Message message = anyMessage(kind);
            RC_ASSERT(message.body.index() == kind);
            const auto back = decoded(encoded(message));
            RC_ASSERT(back.has_value());
            RC_ASSERT(*back == message);
        });
    }
}

TEST_CASE("codec: a truncated message is refused in words, wherever it was cut") {
    law("no proper beginning of a message is a message", [] {
        const auto bytes = encoded(anyMessage(*rc::gen::inRange<std::size_t>(0, kKinds)));
        const auto cut = *rc::gen::inRange<std::size_t>(0, bytes.size());
        const auto back = decoded(std::span(bytes).first(cut));
        RC_ASSERT(!back.has_value());
        RC_ASSERT(back.error().fault == Fault::badFile);
        RC_ASSERT(back.error().what.size() > 20U);
    });
    // The small ones at every length.
    const auto bytes = encoded({7, Refused{{Fault::device, "No lens."}, true}});
    for (std::size_t cut = 0; cut < bytes.size(); ++cut)
        CHECK_FALSE(decoded(std::span(bytes).first(cut)).has_value());
}

TEST_CASE("codec: random bytes and damaged messages never crash, and damage never changes a program unnoticed") {
    law("random bytes are refused", [] {
        const auto bytes = *rc::gen::container<std::vector<std::uint8_t>>(rc::gen::arbitrary<std::uint8_t>());
        RC_ASSERT(!decoded(std::as_bytes(std::span(bytes))).has_value());
    });
    law("a flipped byte is refused, or ends in another message that is refused or is the same program", [] {
        const auto program = test::program(*rc::gen::inRange(0U, 50U));
        auto bytes = encoded({1, difference(program, contentHash(program))});
        const auto at = *rc::gen::inRange<std::size_t>(0, bytes.size());
        bytes[at] ^= std::byte(*rc::gen::inRange(1, 256));
        const auto back = decoded(bytes);
        if (!back) return;
        const auto* update = std::get_if<ProgramUpdate>(&back->body);
        if (update == nullptr) return;
        const auto whole = assembled(*update);
        RC_ASSERT(!whole || *whole == program);
    });
}

TEST_CASE("codec: a hundred thousand messages of noise, and damaged ones of every kind, are refused or are messages") {
    std::vector<std::vector<std::byte>> whole;
    law("one of each kind can be made", [&] {
        if (whole.size() < kKinds) whole.push_back(encoded(anyMessage(whole.size())));
    });
    REQUIRE(whole.size() == kKinds);
    for (Fuzz fuzz; fuzz.goesOn();) {
        std::vector<std::byte> bytes = whole[fuzz.below(kKinds)];
        if (fuzz.below(4) == 0)
            bytes = fuzz.bytes<std::byte>(400);
        else
            fuzz.damage(bytes);
        const auto back = decoded(bytes);
        REQUIRE((back || back.error().what.size() > 20));
    }
}

TEST_CASE("codec: a message for a projector that nobody builds is refused") {
    auto update = difference(test::program(1), 1);
    update.projector = {9000, 100};
    const auto back = decoded(encoded({1, update}));
    REQUIRE_FALSE(back.has_value());
    CHECK(back.error().what == "a message names an impossible projector width.");
}

}  // namespace ilf::devices
