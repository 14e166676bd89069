#include "projects/picture_icc.h"

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <string_view>
#include <utility>
#include <vector>

#include "projects/big_endian.h"

namespace ilf::projects {
namespace {

/// s15Fixed16Number.
std::string fixed(std::initializer_list<double> values) {
    std::string bytes;
    for (const double value : values)
        bytes += bigEndian(static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(value * 65536.0))));
    return bytes;
}

std::string tag(std::string_view type, const std::string& content) {
    return std::string(type) + bigEndian(0) + content;
}

/// multiLocalizedUnicodeType with one text, in ASCII.
std::string text(std::string_view ascii) {
    std::string utf16;
    for (const char c : ascii)
        utf16 += {'\0', c};
    return tag("mluc", bigEndian(1) + bigEndian(12) + "enUS" + bigEndian(static_cast<std::uint32_t>(utf16.size())) +
                           bigEndian(28) + utf16);
}

}  // namespace

std::string srgbProfile() {
    const std::string d50 = fixed({0.9642, 1.0, 0.8249});
    // Function 3: (a x + b)^g above d, c x below (IEC 61966-2-1).
    const std::string curve =
        tag("para", std::string("\0\3\0\0", 4) + fixed({2.4, 1.0 / 1.055, 0.055 / 1.055, 1.0 / 12.92, 0.04045}));
    // Primaries and white of sRGB, adapted from D65 to D50 by Bradford's matrix, which "chad" states.
    const std::vector<std::pair<std::string_view, std::string>> tags = {
        {"desc", text("sRGB")},
        {"cprt", text("No copyright")},
        {"wtpt", tag("XYZ ", d50)},
        {"chad",
         tag("sf32", fixed({1.04788, 0.02292, -0.05022, 0.02959, 0.99048, -0.01707, -0.00925, 0.01508, 0.75168}))},
        {"rXYZ", tag("XYZ ", fixed({0.43607, 0.22249, 0.01392}))},
        {"gXYZ", tag("XYZ ", fixed({0.38515, 0.71687, 0.09708}))},
        {"bXYZ", tag("XYZ ", fixed({0.14307, 0.06061, 0.71410}))},
        {"rTRC", curve},
        {"gTRC", curve},
        {"bTRC", curve},
    };
    const auto first = static_cast<std::uint32_t>(128 + 4 + 12 * tags.size());
    std::string table = bigEndian(static_cast<std::uint32_t>(tags.size())), data;
    for (const auto& [name, content] : tags) {
        table += std::string(name) + bigEndian(first + static_cast<std::uint32_t>(data.size())) +
                 bigEndian(static_cast<std::uint32_t>(content.size()));
        data += content;
        data.resize((data.size() + 3) / 4 * 4);
    }
    std::string header = bigEndian(0) + bigEndian(0) + bigEndian(0x04300000) + "mntrRGB XYZ ";
    header += std::string("\x07\xea\0\1\0\1\0\0\0\0\0\0", 12) + "acsp" + bigEndian(0) + bigEndian(0) + bigEndian(0) +
              bigEndian(0);
    header += bigEndian(0) + bigEndian(0) + bigEndian(0) + d50;
    header.resize(128);
    std::string profile = header + table + data;
    profile.replace(0, 4, bigEndian(static_cast<std::uint32_t>(profile.size())));
    return profile;
}

}  // namespace ilf::projects
