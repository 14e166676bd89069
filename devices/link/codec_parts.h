// What the files of the codec share: texts and enumerations out of bytes. Private to the codec.
#pragma once

#include <bit>
#include <cstring>
#include <string>
#include <vector>

#include "devices/link/codec.h"
#include "messages_generated.h"

namespace ilf::devices::codec {

inline Result<int> within(int value, int most, const char* what) {
    if (value > most) return fail(Fault::badFile, std::string("a message names an impossible ") + what + ".");
    return value;
}

template <class To, class From>
Result<To> enumeration(From value, From last, const char* what) {
    if (value > last) return fail(Fault::badFile, std::string("a message holds an unknown ") + what + ".");
    return static_cast<To>(value);
}

/// The numbers of a message. The verifier sees that they are all there, not that they lie as their type must, so they
/// are copied byte by byte; null is none.
template <class T>
std::vector<T> numbers(const flatbuffers::Vector<T>* from) {
    static_assert(std::endian::native == std::endian::little, "messages are little-endian");
    if (from == nullptr || from->size() == 0) return {};
    std::vector<T> out(from->size());
    std::memcpy(out.data(), from->Data(), out.size() * sizeof(T));
    return out;
}

inline std::string text(const flatbuffers::String* s) { return s != nullptr ? s->str() : std::string(); }

// codec_rig.cpp: the messages of an emulated rig, and what the status says of devices.
using flatbuffers::FlatBufferBuilder;
using flatbuffers::Offset;
using DeviceLines = flatbuffers::Vector<Offset<wire::DeviceLine>>;
using Texts = flatbuffers::Vector<Offset<flatbuffers::String>>;

Offset<void> encode(FlatBufferBuilder& fb, const ReadReceived& m);
Offset<void> encode(FlatBufferBuilder& fb, const ReadExposure& m);
Offset<void> encode(FlatBufferBuilder& fb, const Received& m);
Offset<void> encode(FlatBufferBuilder& fb, const ExposedLight& m);
Offset<void> encode(FlatBufferBuilder& fb, const RigMishap& m);
Offset<wire::StageTiming> encode(FlatBufferBuilder& fb, const StageTiming& timing);
Offset<DeviceLines> encode(FlatBufferBuilder& fb, const std::vector<DeviceLine>& lines);

Result<Body> decode(const wire::Received& m);
Result<Body> decode(const wire::ExposedLight& m);
Result<Body> decode(const wire::RigMishap& m);
StageTiming decode(const wire::StageTiming& timing);
Result<std::vector<DeviceLine>> decode(const DeviceLines* lines);
std::vector<std::string> decode(const Texts* texts);

}  // namespace ilf::devices::codec
