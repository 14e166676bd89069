// Little-endian numbers in and out of a message's bytes.
#pragma once

#include <string>
#include <vector>

#include "devices/dlpc350/messages.h"

namespace ilf::devices::dlpc350 {

inline int u16At(Data data, std::size_t at) { return data[at] | (data[at + 1] << 8); }
inline std::uint32_t u32At(Data data, std::size_t at) {
    return static_cast<std::uint32_t>(u16At(data, at)) | (static_cast<std::uint32_t>(u16At(data, at + 2)) << 16);
}
inline void appendU32(std::vector<std::uint8_t>& bytes, std::uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8)
        bytes.push_back(static_cast<std::uint8_t>(value >> shift));
}

/// What a decoder says of data that ends too early.
inline tl::unexpected<Error> tooShort(const char* what, std::size_t found, std::size_t wanted) {
    return fail(Fault::badFile, std::string("The reply to \"") + what + "\" has " + std::to_string(found) + " of " +
                                    std::to_string(wanted) + " bytes.");
}

}  // namespace ilf::devices::dlpc350
