#include "projects/gltf/beside.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <optional>
#include <system_error>

#include "projects/gltf/findings.h"
#include "projects/safe_file.h"

namespace ilf::projects::gltf {

namespace {

tl::unexpected<std::string> because(std::string why) { return tl::unexpected<std::string>(std::move(why)); }

std::string inQuotes(const std::string& uri) {
    return "\"" + (uri.size() > 80 ? uri.substr(0, 77) + "..." : uri) + "\"";
}

int hexDigit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    const char lower = static_cast<char>(c | 0x20);
    return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

std::string percentDecoded(std::string_view text) {
    std::string decoded;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool code =
            text[i] == '%' && i + 2 < text.size() && hexDigit(text[i + 1]) >= 0 && hexDigit(text[i + 2]) >= 0;
        decoded.push_back(code ? static_cast<char>(hexDigit(text[i + 1]) * 16 + hexDigit(text[i + 2])) : text[i]);
        if (code) i += 2;
    }
    return decoded;
}

std::optional<std::string> fromBase64(std::string_view text) {
    static constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    static const std::array<std::int8_t, 256> kValue = [] {
        std::array<std::int8_t, 256> value{};
        value.fill(-1);
        for (std::size_t i = 0; i < kDigits.size(); ++i)
            value[static_cast<unsigned char>(kDigits[i])] = static_cast<std::int8_t>(i);
        return value;
    }();
    while (!text.empty() && text.back() == '=')
        text.remove_suffix(1);
    if (text.size() % 4 == 1) return std::nullopt;
    std::string bytes;
    bytes.reserve(text.size() * 3 / 4);
    std::uint32_t held = 0;
    unsigned bits = 0;
    for (const char c : text) {
        const int value = kValue[static_cast<unsigned char>(c)];
        if (value < 0) return std::nullopt;
        held = (held << 6U | static_cast<std::uint32_t>(value)) & 0xFFFFFU;
        bits += 6;
        if (bits >= 8) {
            bits -= 8;
            bytes.push_back(static_cast<char>(held >> bits & 0xFFU));
        }
    }
    return bytes;
}

std::string lowered(std::string_view text) {
    std::string lower(text);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return lower;
}

struct DataUri {
    std::string kind;  ///< MIME type, lower case
    std::string bytes;
};

/// RFC 2397. Nothing where the text breaks its rules.
std::optional<DataUri> parsedData(std::string_view uri) {
    const auto comma = uri.find(',');
    if (comma == std::string_view::npos) return std::nullopt;
    std::string_view head = uri.substr(5, comma - 5);
    const auto kindEnd = head.find(';');
    DataUri data{lowered(head.substr(0, kindEnd)), {}};
    bool base64 = false;
    while (head.find(';') != std::string_view::npos) {
        head.remove_prefix(head.find(';') + 1);
        const std::string_view parameter = head.substr(0, head.find(';'));
        if (base64) return std::nullopt;
        base64 = lowered(parameter) == "base64";
        if (!base64 && parameter.find('=') == std::string_view::npos) return std::nullopt;
    }
    const std::string_view content = uri.substr(comma + 1);
    if (!base64) {
        data.bytes = percentDecoded(content);
    } else if (auto bytes = fromBase64(content)) {
        data.bytes = std::move(*bytes);
    } else {
        return std::nullopt;
    }
    return data;
}

bool isData(const std::string& uri) { return lowered(std::string_view(uri).substr(0, 5)) == "data:"; }

bool hasScheme(const std::string& uri) {
    const auto colon = uri.find(':');
    return colon != std::string::npos &&
           std::all_of(uri.begin(), uri.begin() + static_cast<std::ptrdiff_t>(colon),
                       [](unsigned char c) { return std::isalnum(c) != 0 || c == '+' || c == '-' || c == '.'; });
}

}  // namespace

Beside::Beside(const std::filesystem::path& gltf) {
    std::error_code ignored;
    const auto folder = gltf.has_parent_path() ? gltf.parent_path() : std::filesystem::path(".");
    folder_ = std::filesystem::weakly_canonical(folder, ignored);
}

Bytes Beside::buffer(const std::string& uri) const {
    if (!isData(uri)) return file(uri);
    auto data = parsedData(uri);
    if (!data) return because("is a damaged data URI");
    if (data->kind != "application/octet-stream" && data->kind != "application/gltf-buffer")
        return because("is a data URI of the kind " + inQuotes(data->kind) + ", which is none of glTF's buffers");
    return std::move(data->bytes);
}

Bytes Beside::image(const std::string& uri) const {
    if (!isData(uri)) return file(uri);
    auto data = parsedData(uri);
    if (!data) return because("is a damaged data URI");
    return std::move(data->bytes);
}

Bytes Beside::file(const std::string& uri) const {
    if (hasScheme(uri))
        return because("names " + inQuotes(uri) + ": only files beside the scene are read, nothing is fetched");
    const auto inFolder = [&](const std::string& name) -> Bytes {
        const std::filesystem::path relative(name);
        const bool up = std::any_of(relative.begin(), relative.end(), [](const auto& part) { return part == ".."; });
        if (name.empty() || name.find('\0') != std::string::npos || name.find('\\') != std::string::npos ||
            relative.is_absolute() || up)
            return because("names " + inQuotes(uri) + ", which is not a file beneath the scene's own folder");
        std::error_code error;
        const auto path = std::filesystem::canonical(folder_ / relative, error);
        if (error) return because("names " + inQuotes(uri) + ", which is not there (it belongs beside the scene)");
        const auto inside = std::mismatch(folder_.begin(), folder_.end(), path.begin(), path.end());
        if (inside.first != folder_.end())
            return because("names " + inQuotes(uri) + ", a link that leads out of the scene's own folder");
        auto bytes = readWhole(path, kMaxBytes);
        if (!bytes) return because("names a file that cannot be read: " + bytes.error().what);
        return std::move(*bytes);
    };
    auto bytes = inFolder(percentDecoded(uri));
    // Some programs write a file's name as it is, whatever signs are in it.
    if (!bytes && uri.find('%') != std::string::npos) {
        if (auto asWritten = inFolder(uri)) return asWritten;
    }
    return bytes;
}

}  // namespace ilf::projects::gltf
