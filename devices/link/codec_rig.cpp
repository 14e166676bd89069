#include "devices/link/codec_parts.h"

namespace ilf::devices::codec {
namespace {

std::vector<double> plain(const std::vector<Dioptre>& powers) {
    std::vector<double> out;
    out.reserve(powers.size());
    for (const Dioptre power : powers)
        out.push_back(power.si());
    return out;
}

std::vector<Dioptre> powers(const flatbuffers::Vector<double>* plain) {
    std::vector<Dioptre> out;
    for (const double power : numbers(plain))
        out.push_back(Dioptre::fromSi(power));
    return out;
}

}  // namespace

Offset<void> encode(FlatBufferBuilder& fb, const ReadReceived&) { return wire::CreateReadReceived(fb).Union(); }
Offset<void> encode(FlatBufferBuilder& fb, const ReadExposure& m) {
    return wire::CreateReadExposure(fb, static_cast<std::uint16_t>(m.number)).Union();
}

Offset<void> encode(FlatBufferBuilder& fb, const Received& m) {
    std::vector<Offset<wire::Exposure>> exposures;
    for (const Exposure& e : m.exposures)
        exposures.push_back(wire::CreateExposure(fb, e.start.si(), e.length.si(), static_cast<std::uint8_t>(e.bits),
                                                 static_cast<std::uint8_t>(e.colours), e.video));
    const auto exposed = fb.CreateVector(exposures);
    const auto left = fb.CreateVector(plain(m.left)), right = fb.CreateVector(plain(m.right));
    const auto log = fb.CreateVectorOfStrings(m.log);
    return wire::CreateReceived(fb, m.trigger_ns, m.sweep.si(), static_cast<std::uint16_t>(m.raster.width),
                                static_cast<std::uint16_t>(m.raster.height), exposed, left, right, m.temperature_C[0],
                                m.temperature_C[1], m.most_mA[0], m.most_mA[1], m.patterns, m.harmed,
                                m.ledCurrentWrites, m.frames, m.triggers, m.transfers, log)
        .Union();
}

Offset<void> encode(FlatBufferBuilder& fb, const ExposedLight& m) {
    const auto light = fb.CreateVector(m.light);
    return wire::CreateExposedLight(fb, static_cast<std::uint16_t>(m.number),
                                    static_cast<std::uint16_t>(m.raster.width),
                                    static_cast<std::uint16_t>(m.raster.height), light)
        .Union();
}

Offset<void> encode(FlatBufferBuilder& fb, const RigMishap& m) {
    const auto device = fb.CreateString(m.device), kind = fb.CreateString(m.kind);
    return wire::CreateRigMishap(fb, device, kind, m.after, m.times, m.amount).Union();
}

Offset<wire::StageTiming> encode(FlatBufferBuilder& fb, const StageTiming& t) {
    return wire::CreateStageTiming(fb, t.locked, t.phase.si(), t.jitter.si(), t.driftPpm, t.missedTriggers);
}

Offset<DeviceLines> encode(FlatBufferBuilder& fb, const std::vector<DeviceLine>& lines) {
    std::vector<Offset<wire::DeviceLine>> out;
    for (const DeviceLine& line : lines) {
        const auto what = fb.CreateString(line.what), name = fb.CreateString(line.name),
                   sentence = fb.CreateString(line.line);
        out.push_back(wire::CreateDeviceLine(fb, what, static_cast<wire::DeviceHealth>(line.health), name, sentence));
    }
    return fb.CreateVector(out);
}

Result<Body> decode(const wire::Received& m) {
    Received r;
    r.trigger_ns = m.trigger_ns();
    r.sweep = Second::fromSi(m.sweep_s());
    r.raster = {m.width(), m.height()};
    if (m.exposures() != nullptr)
        for (const auto* e : *m.exposures())
            r.exposures.push_back(
                {Second::fromSi(e->start_s()), Second::fromSi(e->length_s()), e->bits(), e->colours(), e->video()});
    r.left = powers(m.left_D());
    r.right = powers(m.right_D());
    r.temperature_C = {m.left_C(), m.right_C()};
    r.most_mA = {m.left_mA(), m.right_mA()};
    r.patterns = m.patterns();
    r.harmed = m.harmed();
    r.ledCurrentWrites = m.led_current_writes();
    r.frames = m.frames();
    r.triggers = m.triggers();
    r.transfers = m.transfers();
    r.log = decode(m.log());
    return Body(std::move(r));
}

Result<Body> decode(const wire::ExposedLight& m) {
    const auto width = within(m.width(), kMaxSide, "projector width");
    const auto height = within(m.height(), kMaxSide, "projector height");
    if (!width) return tl::unexpected(width.error());
    if (!height) return tl::unexpected(height.error());
    const std::size_t pixels = static_cast<std::size_t>(*width) * static_cast<std::size_t>(*height);
    if (m.light()->size() != pixels)
        return fail(Fault::badFile, "a message holds the light of " + std::to_string(m.light()->size()) +
                                        " pixels instead of " + std::to_string(pixels) + ".");
    return Body(ExposedLight{m.number(), {*width, *height}, {m.light()->begin(), m.light()->end()}});
}

Result<Body> decode(const wire::RigMishap& m) {
    return Body(RigMishap{text(m.device()), text(m.kind()), m.after(), m.times(), m.amount()});
}

StageTiming decode(const wire::StageTiming& t) {
    return {t.locked(), Second::fromSi(t.phase_s()), Second::fromSi(t.jitter_s()), t.drift_ppm(), t.missed_triggers()};
}

Result<std::vector<DeviceLine>> decode(const DeviceLines* lines) {
    std::vector<DeviceLine> out;
    if (lines == nullptr) return out;
    for (const auto* line : *lines) {
        const auto health = enumeration<DeviceHealth>(line->health(), wire::DeviceHealth::MAX, "state of a device");
        if (!health) return tl::unexpected(health.error());
        out.push_back({text(line->what()), *health, text(line->name()), text(line->line())});
    }
    return out;
}

std::vector<std::string> decode(const Texts* texts) {
    std::vector<std::string> out;
    if (texts == nullptr) return out;
    for (const auto* one : *texts)
        out.push_back(one->str());
    return out;
}

}  // namespace ilf::devices::codec
