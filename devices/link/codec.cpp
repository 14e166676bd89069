#include "devices/link/codec.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "devices/link/codec_parts.h"

namespace ilf::devices {
namespace {

using namespace codec;
// Declared here, so that they are overloads of those below and not hidden by them.
using codec::decode;
using codec::encode;
constexpr std::size_t kTileBytes = static_cast<std::size_t>(kTile) * kTile;

// ---- values to bytes ----

Offset<flatbuffers::Vector<double>> encode(FlatBufferBuilder& fb, const Harmonics& f) {
    std::vector<double> parts;
    for (const auto& c : f.c)
        parts.insert(parts.end(), {c.real(), c.imag()});
    return fb.CreateVector(parts);
}

Offset<wire::Waveform> encode(FlatBufferBuilder& fb, const Waveform& w) {
    const auto power = encode(fb, w.power);
    const auto drive = encode(fb, w.drive);
    return wire::CreateWaveform(fb, w.rest.si(), w.low.si(), w.high.si(), w.rate.si(), power, drive,
                                static_cast<wire::DriveUnit>(w.unit), static_cast<wire::WaveMode>(w.mode), w.wave,
                                static_cast<wire::Provenance>(w.provenance), w.temperature_C, w.warming_C);
}

std::size_t bytesOf(const TilePart& part) { return static_cast<std::size_t>(part.width * part.height); }

Offset<flatbuffers::Vector<std::uint8_t>> partOf(FlatBufferBuilder& fb, const TileUpdate& t) {
    std::uint8_t* to = nullptr;
    const auto values = fb.CreateUninitializedVector(bytesOf(t.part), 1, &to);
    for (int y = t.part.y; y < t.part.y + t.part.height; ++y)
        to = std::copy_n(t.tile->v.data() + y * kTile + t.part.x, t.part.width, to);
    return values;
}

Offset<flatbuffers::Vector<Offset<wire::Tile>>> encode(FlatBufferBuilder& fb, const std::vector<TileUpdate>& tiles) {
    std::vector<Offset<wire::Tile>> out;
    out.reserve(tiles.size());
    for (const auto& t : tiles) {
        const auto& v = t.tile->v;
        const bool uniform = t.tile.same(uniformTile(v[0]));
        const bool whole = t.part.isWhole();
        const auto values = whole ? fb.CreateVector(v.data(), uniform ? 1 : v.size()) : partOf(fb, t);
        const auto byte = [whole](int value) { return static_cast<std::uint8_t>(whole ? 0 : value); };
        out.push_back(wire::CreateTile(fb, static_cast<std::uint16_t>(t.image), static_cast<std::uint16_t>(t.column),
                                       static_cast<std::uint16_t>(t.row), values, byte(t.part.x), byte(t.part.y),
                                       byte(t.part.width), byte(t.part.height)));
    }
    return fb.CreateVector(out);
}

Offset<void> encode(FlatBufferBuilder& fb, const Hello& m) {
    return wire::CreateHello(fb, fb.CreateString(m.role)).Union();
}
Offset<void> encode(FlatBufferBuilder& fb, const ProgramUpdate& m) {
    std::vector<std::int16_t> imageOfSlot(m.imageOfSlot.size());
    std::transform(m.imageOfSlot.begin(), m.imageOfSlot.end(), imageOfSlot.begin(),
                   [](int i) { return static_cast<std::int16_t>(i); });
    const auto waveform = encode(fb, m.waveform);
    const auto slots = fb.CreateVector(imageOfSlot);
    const auto tiles = encode(fb, m.tiles);
    return wire::CreateProgramUpdate(
               fb, m.revision, static_cast<wire::Why>(m.why), m.hold, m.base.has_value(), m.base.value_or(0), m.hash,
               waveform, m.slotRate.si(), m.projectorDelay.si(), static_cast<std::uint16_t>(m.projector.width),
               static_cast<std::uint16_t>(m.projector.height), static_cast<std::uint16_t>(m.images), slots, tiles)
        .Union();
}
Offset<void> encode(FlatBufferBuilder& fb, const Ack& m) { return wire::CreateAck(fb, m.revision, m.hash).Union(); }
Offset<void> encode(FlatBufferBuilder& fb, const Refused& m) {
    return wire::CreateRefused(fb, static_cast<wire::Fault>(m.error.fault), fb.CreateString(m.error.what), m.sendWhole)
        .Union();
}
Offset<void> encode(FlatBufferBuilder& fb, const SafeLight&) { return wire::CreateSafeLight(fb).Union(); }
Offset<void> encode(FlatBufferBuilder& fb, const Status& m) {
    const auto projector = fb.CreateString(m.projectorLine);
    const auto lens = fb.CreateString(m.lensLine);
    const auto fault = fb.CreateString(m.fault);
    const auto refusal = fb.CreateString(m.lastRefusal);
    const auto lensName = fb.CreateString(m.lensName);
    const auto devices = encode(fb, m.devices);
    const auto limits = fb.CreateVectorOfStrings(m.limits);
    const auto timing = m.timing ? encode(fb, *m.timing) : Offset<wire::StageTiming>();
    wire::StatusBuilder b(fb);
    b.add_light(static_cast<wire::Light>(m.light));
    b.add_hold(m.hold);
    b.add_revision_played(m.revisionPlayed);
    b.add_hash_played(m.contentHashPlayed);
    b.add_swaps(m.swaps);
    b.add_dropped_updates(m.droppedUpdates);
    b.add_received_ns(m.received_ns);
    b.add_loaded_ns(m.loaded_ns);
    b.add_swapped_ns(m.swapped_ns);
    b.add_lens(static_cast<wire::LensMode>(m.lens));
    b.add_lens_power_D(m.lensPower.si());
    b.add_low_D(m.low.si());
    b.add_high_D(m.high.si());
    b.add_projector_line(projector);
    b.add_lens_line(lens);
    b.add_projector_well(m.projectorWell);
    b.add_lens_well(m.lensWell);
    b.add_fault(fault);
    b.add_faults(m.faults);
    b.add_pid(m.pid);
    b.add_simulated(m.simulated);
    b.add_supervisor_pid(m.supervisorPid);
    b.add_last_refusal(refusal);
    b.add_lens_name(lensName);
    b.add_emulated(m.emulated);
    if (m.timing) b.add_timing(timing);
    b.add_has_lens_temperature(m.lensTemperature_C.has_value());
    b.add_lens_temperature_C(m.lensTemperature_C.value_or(0.0));
    b.add_devices(devices);
    b.add_limits(limits);
    return b.Finish().Union();
}
Offset<void> encode(FlatBufferBuilder& fb, const SetWaveform& m) {
    return wire::CreateSetWaveform(fb, encode(fb, m.waveform)).Union();
}
Offset<void> encode(FlatBufferBuilder& fb, const SetSlotRate& m) {
    return wire::CreateSetSlotRate(fb, m.rate.si()).Union();
}
Offset<void> encode(FlatBufferBuilder& fb, const Swap&) { return wire::CreateSwap(fb).Union(); }
Offset<void> encode(FlatBufferBuilder& fb, const SteadyLight&) { return wire::CreateSteadyLight(fb).Union(); }
Offset<void> encode(FlatBufferBuilder& fb, const LensToRest&) { return wire::CreateLensToRest(fb).Union(); }
Offset<void> encode(FlatBufferBuilder& fb, const Read&) { return wire::CreateRead(fb).Union(); }
Offset<void> encode(FlatBufferBuilder& fb, const ReadSlot& m) {
    return wire::CreateReadSlot(fb, static_cast<std::uint16_t>(m.slot)).Union();
}
Offset<void> encode(FlatBufferBuilder& fb, const InjectFault& m) {
    return wire::CreateInjectFault(fb, static_cast<wire::FaultKind>(m.kind), m.afterCalls).Union();
}
Offset<void> encode(FlatBufferBuilder& fb, const Done& m) { return wire::CreateDone(fb, m.at_ns).Union(); }
Offset<void> encode(FlatBufferBuilder& fb, const SlotImage& m) {
    std::vector<TileUpdate> tiles;
    for (int row = 0; row < m.image.rows(); ++row)
        for (int column = 0; column < m.image.columns(); ++column)
            if (!m.image.isUniform(column, row, 0)) tiles.push_back({0, column, row, m.image.tile(column, row)});
    const auto encodedTiles = encode(fb, tiles);
    return wire::CreateSlotImage(fb, static_cast<std::uint16_t>(m.slot),
                                 static_cast<std::uint16_t>(m.image.size().width),
                                 static_cast<std::uint16_t>(m.image.size().height), m.hash, encodedTiles)
        .Union();
}
Offset<void> encode(FlatBufferBuilder& fb, const DeviceState& m) {
    const auto hashes = fb.CreateVector(m.slotHashes);
    const auto waveform = encode(fb, m.waveform);
    const auto log = fb.CreateVectorOfStrings(m.log);
    const auto lensName = fb.CreateString(m.lensName);
    wire::DeviceStateBuilder b(fb);
    b.add_now_ns(m.now_ns);
    b.add_light(static_cast<wire::Light>(m.light));
    b.add_slot_rate_Hz(m.slotRate.si());
    b.add_hash_shown(m.hashShown);
    b.add_hash_loaded(m.hashLoaded);
    b.add_slot_hashes(hashes);
    b.add_swaps(m.swaps);
    b.add_swapped_ns(m.swapped_ns);
    b.add_lens(static_cast<wire::LensMode>(m.lens));
    b.add_waveform(waveform);
    b.add_power_D(m.powerNow.si());
    b.add_lens_error_D(m.lensError.si());
    b.add_rate_changes_under_slotted_light(m.rateChangesUnderSlottedLight);
    b.add_waveform_changes_under_slotted_light(m.waveformChangesUnderSlottedLight);
    b.add_refusals(m.refusals);
    b.add_watchdog_trips(m.watchdogTrips);
    b.add_calls(m.calls);
    b.add_tiles_received(m.tilesReceived);
    b.add_pid(m.pid);
    b.add_log(log);
    b.add_lens_name(lensName);
    b.add_off_wave_D(m.offWave.si());
    b.add_lens_temperature_C(m.lensTemperature_C);
    b.add_phase_error_s(m.phaseError.si());
    b.add_triggers_lost(m.triggersLost);
    return b.Finish().Union();
}

// ---- bytes to values; the verifier has seen to the offsets ----

Result<Harmonics> decode(const flatbuffers::Vector<double>* parts) {
    Harmonics f;
    if (parts == nullptr) return f;
    if (parts->size() % 2 != 0 || parts->size() > 2 * kMaxHarmonics)
        return fail(Fault::badFile, "a message holds a lens wave of " + std::to_string(parts->size()) + " numbers.");
    const std::vector<double> values = numbers(parts);
    for (std::size_t i = 0; i < values.size(); i += 2)
        f.c.emplace_back(values[i], values[i + 1]);
    return f;
}

Result<Waveform> decode(const wire::Waveform& w) {
    const auto mode = enumeration<WaveMode>(w.mode(), wire::WaveMode::MAX, "kind of lens wave");
    const auto unit = enumeration<DriveUnit>(w.unit(), wire::DriveUnit::MAX, "unit of a lens drive");
    const auto provenance = enumeration<Provenance>(w.provenance(), wire::Provenance::MAX, "provenance");
    auto power = decode(w.power_D());
    auto drive = decode(w.drive());
    if (!mode) return tl::unexpected(mode.error());
    if (!unit) return tl::unexpected(unit.error());
    if (!provenance) return tl::unexpected(provenance.error());
    if (!power) return tl::unexpected(power.error());
    if (!drive) return tl::unexpected(drive.error());
    Waveform wave;
    wave.mode = *mode;
    wave.rest = Dioptre::fromSi(w.rest_D());
    wave.low = Dioptre::fromSi(w.low_D());
    wave.high = Dioptre::fromSi(w.high_D());
    wave.rate = Hertz::fromSi(w.rate_Hz());
    wave.power = *std::move(power);
    wave.drive = *std::move(drive);
    wave.unit = *unit;
    wave.wave = w.wave();
    wave.provenance = *provenance;
    wave.temperature_C = w.temperature_C();
    wave.warming_C = w.warming_C();
    return wave;
}

Result<std::vector<TileUpdate>> decode(const flatbuffers::Vector<Offset<wire::Tile>>& tiles) {
    if (tiles.size() > kMaxTiles) return fail(Fault::badFile, "a message holds more tiles than any program has.");
    std::vector<TileUpdate> out;
    out.reserve(tiles.size());
    for (const auto* t : tiles) {
        const auto* values = t->values();
        if (t->width() != 0) {
            const TilePart part{t->x(), t->y(), t->width(), t->height()};
            if (part.height < 1 || part.x + part.width > kTile || part.y + part.height > kTile ||
                values->size() != bytesOf(part))
                return fail(Fault::badFile, "a message holds a part of a tile that does not fit into it.");
            Tile tile;
            const std::uint8_t* from = values->data();
            for (int y = part.y; y < part.y + part.height; ++y, from += part.width)
                std::copy_n(from, part.width, tile.v.data() + y * kTile + part.x);
            out.push_back({t->image(), t->column(), t->row(), boxed(tile), part});
            continue;
        }
        if (values->size() != 1 && values->size() != kTileBytes)
            return fail(Fault::badFile, "a message holds a tile of " + std::to_string(values->size()) +
                                            " bytes; a tile has 1 or " + std::to_string(kTileBytes) + ".");
        TileUpdate update{t->image(), t->column(), t->row(), {}};
        if (values->size() == 1) {
            update.tile = uniformTile(values->Get(0));
        } else {
            Tile tile;
            std::memcpy(tile.v.data(), values->data(), kTileBytes);
            update.tile = boxed(tile);
        }
        out.push_back(std::move(update));
    }
    return out;
}

Result<Body> decode(const wire::ProgramUpdate& m) {
    const auto why = enumeration<Why>(m.why(), wire::Why::MAX, "purpose");
    if (!why) return tl::unexpected(why.error());
    for (const auto& fits :
         {within(m.width(), kMaxSide, "projector width"), within(m.height(), kMaxSide, "projector height"),
          within(m.images(), kMaxImages, "number of images"),
          within(static_cast<int>(std::min<std::size_t>(m.image_of_slot()->size(), kMaxSlots + 1)), kMaxSlots,
                 "number of slots")})
        if (!fits) return tl::unexpected(fits.error());
    auto tiles = decode(*m.tiles());
    if (!tiles) return tl::unexpected(tiles.error());
    auto waveform = decode(*m.waveform());
    if (!waveform) return tl::unexpected(waveform.error());
    ProgramUpdate update;
    update.revision = m.revision();
    update.why = *why;
    update.hold = m.hold();
    if (m.has_base()) update.base = m.base_hash();
    update.hash = m.hash();
    update.waveform = *std::move(waveform);
    update.slotRate = Hertz::fromSi(m.slot_rate_Hz());
    update.projectorDelay = Second::fromSi(m.projector_delay_s());
    update.projector = {m.width(), m.height()};
    update.images = m.images();
    const std::vector<std::int16_t> images = numbers(m.image_of_slot());
    update.imageOfSlot.assign(images.begin(), images.end());
    update.tiles = *std::move(tiles);
    return Body(std::move(update));
}

Result<Body> decode(const wire::Status& m) {
    const auto light = enumeration<LightMode>(m.light(), wire::Light::MAX, "light mode");
    const auto lens = enumeration<LensMode>(m.lens(), wire::LensMode::MAX, "lens mode");
    if (!light) return tl::unexpected(light.error());
    if (!lens) return tl::unexpected(lens.error());
    Status s;
    s.light = *light;
    s.hold = m.hold();
    s.revisionPlayed = m.revision_played();
    s.contentHashPlayed = m.hash_played();
    s.swaps = m.swaps();
    s.droppedUpdates = m.dropped_updates();
    s.received_ns = m.received_ns();
    s.loaded_ns = m.loaded_ns();
    s.swapped_ns = m.swapped_ns();
    s.lens = *lens;
    s.lensPower = Dioptre::fromSi(m.lens_power_D());
    s.low = Dioptre::fromSi(m.low_D());
    s.high = Dioptre::fromSi(m.high_D());
    s.projectorLine = text(m.projector_line());
    s.lensLine = text(m.lens_line());
    s.projectorWell = m.projector_well();
    s.lensWell = m.lens_well();
    s.fault = text(m.fault());
    s.faults = m.faults();
    s.pid = m.pid();
    s.supervisorPid = m.supervisor_pid();
    s.simulated = m.simulated();
    s.lastRefusal = text(m.last_refusal());
    s.lensName = text(m.lens_name());
    s.emulated = m.emulated();
    if (m.timing() != nullptr) s.timing = decode(*m.timing());
    if (m.has_lens_temperature()) s.lensTemperature_C = m.lens_temperature_C();
    auto devices = decode(m.devices());
    if (!devices) return tl::unexpected(devices.error());
    s.devices = *std::move(devices);
    s.limits = decode(m.limits());
    return Body(std::move(s));
}

Result<Body> decode(const wire::SlotImage& m) {
    const auto width = within(m.width(), kMaxSide, "projector width");
    const auto height = within(m.height(), kMaxSide, "projector height");
    if (!width) return tl::unexpected(width.error());
    if (!height) return tl::unexpected(height.error());
    auto tiles = decode(*m.tiles());
    if (!tiles) return tl::unexpected(tiles.error());
    SlotImage slot{m.slot(), LightImage(Size{*width, *height}), m.hash()};
    for (auto& t : *tiles) {
        if (t.column >= slot.image.columns() || t.row >= slot.image.rows())
            return fail(Fault::badFile, "a slot image holds a tile outside the projector.");
        slot.image.setTile(t.column, t.row, std::move(t.tile));
    }
    return Body(std::move(slot));
}

Result<Body> decode(const wire::DeviceState& m) {
    const auto light = enumeration<LightMode>(m.light(), wire::Light::MAX, "light mode");
    const auto lens = enumeration<LensMode>(m.lens(), wire::LensMode::MAX, "lens mode");
    if (!light) return tl::unexpected(light.error());
    if (!lens) return tl::unexpected(lens.error());
    auto waveform = decode(*m.waveform());
    if (!waveform) return tl::unexpected(waveform.error());
    DeviceState s;
    s.now_ns = m.now_ns();
    s.light = *light;
    s.slotRate = Hertz::fromSi(m.slot_rate_Hz());
    s.hashShown = m.hash_shown();
    s.hashLoaded = m.hash_loaded();
    s.slotHashes = numbers(m.slot_hashes());
    s.swaps = m.swaps();
    s.swapped_ns = m.swapped_ns();
    s.lens = *lens;
    s.waveform = *std::move(waveform);
    s.powerNow = Dioptre::fromSi(m.power_D());
    s.lensError = Dioptre::fromSi(m.lens_error_D());
    s.rateChangesUnderSlottedLight = m.rate_changes_under_slotted_light();
    s.waveformChangesUnderSlottedLight = m.waveform_changes_under_slotted_light();
    s.refusals = m.refusals();
    s.watchdogTrips = m.watchdog_trips();
    s.calls = m.calls();
    s.tilesReceived = m.tiles_received();
    s.pid = m.pid();
    s.lensName = text(m.lens_name());
    s.offWave = Dioptre::fromSi(m.off_wave_D());
    s.lensTemperature_C = m.lens_temperature_C();
    s.phaseError = Second::fromSi(m.phase_error_s());
    s.triggersLost = m.triggers_lost();
    if (m.log() != nullptr)
        for (const auto* line : *m.log())
            s.log.push_back(line->str());
    return Body(std::move(s));
}

Result<Body> decode(const wire::Refused& m) {
    const auto fault = enumeration<Fault>(m.fault(), wire::Fault::MAX, "kind of refusal");
    if (!fault) return tl::unexpected(fault.error());
    return Body(Refused{{*fault, text(m.what())}, m.send_whole()});
}

Result<Body> decode(const wire::InjectFault& m) {
    const auto kind = enumeration<InjectFault::Kind>(m.kind(), wire::FaultKind::MAX, "kind of fault");
    if (!kind) return tl::unexpected(kind.error());
    return Body(InjectFault{*kind, m.after_calls()});
}

Result<Body> decodeBody(const wire::Message& m) {
    switch (m.body_type()) {
    case wire::Body::Hello:
        return Body(Hello{text(m.body_as_Hello()->role())});
    case wire::Body::ProgramUpdate:
        return decode(*m.body_as_ProgramUpdate());
    case wire::Body::Ack:
        return Body(Ack{m.body_as_Ack()->revision(), m.body_as_Ack()->hash()});
    case wire::Body::Refused:
        return decode(*m.body_as_Refused());
    case wire::Body::SafeLight:
        return Body(SafeLight{});
    case wire::Body::Status:
        return decode(*m.body_as_Status());
    case wire::Body::SetWaveform:
        return decode(*m.body_as_SetWaveform()->waveform()).map([](Waveform&& wave) {
            return Body(SetWaveform{std::move(wave)});
        });
    case wire::Body::SetSlotRate:
        return Body(SetSlotRate{Hertz::fromSi(m.body_as_SetSlotRate()->rate_Hz())});
    case wire::Body::Swap:
        return Body(Swap{});
    case wire::Body::SteadyLight:
        return Body(SteadyLight{});
    case wire::Body::LensToRest:
        return Body(LensToRest{});
    case wire::Body::Read:
        return Body(Read{});
    case wire::Body::ReadSlot:
        return Body(ReadSlot{m.body_as_ReadSlot()->slot()});
    case wire::Body::InjectFault:
        return decode(*m.body_as_InjectFault());
    case wire::Body::Done:
        return Body(Done{m.body_as_Done()->at_ns()});
    case wire::Body::SlotImage:
        return decode(*m.body_as_SlotImage());
    case wire::Body::DeviceState:
        return decode(*m.body_as_DeviceState());
    case wire::Body::ReadReceived:
        return Body(ReadReceived{});
    case wire::Body::ReadExposure:
        return Body(ReadExposure{m.body_as_ReadExposure()->number()});
    case wire::Body::Received:
        return decode(*m.body_as_Received());
    case wire::Body::ExposedLight:
        return decode(*m.body_as_ExposedLight());
    case wire::Body::RigMishap:
        return decode(*m.body_as_RigMishap());
    case wire::Body::NONE:
        break;
    }
    return fail(Fault::badFile, "a message of a kind that this version does not know arrived.");
}

}  // namespace

std::vector<std::byte> encoded(const Message& message) {
    FlatBufferBuilder fb(4096);
    // The order of the variant is the order of the union; 0 is NONE.
    const auto type = static_cast<wire::Body>(message.body.index() + 1);
    const auto body = std::visit([&](const auto& m) { return encode(fb, m); }, message.body);
    wire::FinishSizePrefixedMessageBuffer(fb, wire::CreateMessage(fb, message.id, type, body));
    const auto* begin = reinterpret_cast<const std::byte*>(fb.GetBufferPointer());
    return {begin, begin + fb.GetSize()};
}

Result<Message> decoded(std::span<const std::byte> bytes) {
    // FlatBuffers reads numbers in place and wants them aligned; a socket's buffer is aligned to nothing.
    std::vector<std::uint64_t> aligned;
    if (reinterpret_cast<std::uintptr_t>(bytes.data()) % alignof(std::uint64_t) != 0) {
        aligned.resize(bytes.size() / sizeof(std::uint64_t) + 1);
        std::memcpy(aligned.data(), bytes.data(), bytes.size());
        bytes = {reinterpret_cast<const std::byte*>(aligned.data()), bytes.size()};
    }
    const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
    // The verifier alone would let a few bytes of padding be cut off.
    if (bytes.size() < 16 || flatbuffers::GetPrefixedSize(data) + sizeof(flatbuffers::uoffset_t) != bytes.size())
        return fail(Fault::badFile, "a message arrived incomplete: " + std::to_string(bytes.size()) + " bytes of it.");
    flatbuffers::Verifier verifier(data, bytes.size());
    if (!wire::VerifySizePrefixedMessageBuffer(verifier))
        return fail(Fault::badFile, "a message of " + std::to_string(bytes.size()) + " bytes is damaged.");
    const auto* message = wire::GetSizePrefixedMessage(data);
    auto body = decodeBody(*message);
    if (!body) return tl::unexpected(body.error());
    return Message{message->id(), *std::move(body)};
}

}  // namespace ilf::devices
