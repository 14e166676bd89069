#include "devices/plugin/plugin_words.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>

namespace ilf::devices {
namespace {

/// Bytes of the UTF-8 character that begins at `at`; 0: none does.
std::size_t characterAt(const std::string& text, std::size_t at) {
    const auto first = static_cast<unsigned char>(text[at]);
    const std::size_t bytes = first < 0x80                     ? 1
                              : first >= 0xC2 && first <= 0xDF ? 2
                              : first >= 0xE0 && first <= 0xEF ? 3
                              : first >= 0xF0 && first <= 0xF4 ? 4
                                                               : 0;
    if (bytes == 0 || at + bytes > text.size()) return 0;
    for (std::size_t i = 1; i < bytes; ++i)
        if ((static_cast<unsigned char>(text[at + i]) & 0xC0U) != 0x80U) return 0;
    if (bytes < 3) return bytes;
    // Overlong forms, surrogates, and what lies beyond Unicode.
    const auto second = static_cast<unsigned char>(text[at + 1]);
    const bool wrong = (first == 0xE0 && second < 0xA0) || (first == 0xED && second >= 0xA0) ||
                       (first == 0xF0 && second < 0x90) || (first == 0xF4 && second >= 0x90);
    return wrong ? 0 : bytes;
}

const char* help(ilf_code code) {
    switch (code) {
    case ILF_ABSENT:
        return "connect it and switch it on, then TAKE";
    case ILF_BUSY:
        return "close the other program that uses it, then TAKE";
    case ILF_DENIED:
        return "give your user the right to use it, as its maker says";
    case ILF_TIMED_OUT:
        return "check its cable, or switch it off and on, then TAKE";
    case ILF_REFUSED:
        return "change the rig to what it can do";
    case ILF_FAILED:
        return "check the projector and its cable, then TAKE";
    case ILF_NOT_NOW:
        return "plugin and program misunderstand each other: tell the plugin's author";
    default:
        return "the plugin's author knows what that means";
    }
}

}  // namespace

std::string pluginText(const char* text, std::size_t most) {
    if (text == nullptr) return {};
    std::string said(text, strnlen(text, most));
    for (std::size_t at = 0; at < said.size();) {
        const std::size_t bytes = characterAt(said, at);
        if (bytes == 0) said[at] = '?';
        if (bytes == 1 && (static_cast<unsigned char>(said[at]) < 0x20 || said[at] == 0x7F)) said[at] = ' ';
        at += std::max<std::size_t>(bytes, 1);
    }
    while (!said.empty() && said.back() == ' ')
        said.pop_back();
    return said;
}

Error pluginError(const std::string& plugin, const std::string& what, ilf_code code, const ilf_message& message) {
    std::string said = pluginText(message.text, sizeof message.text);
    if (said.empty()) said = "It says no more than code " + std::to_string(code) + ".";
    const bool known = code > ILF_OK && code <= ILF_NOT_NOW;
    std::string sentence = plugin + " could not " + what + ": \"" + said + "\"; " + help(code) + ".";
    if (!known) sentence += " (Code " + std::to_string(code) + ".)";
    return {code == ILF_REFUSED ? Fault::outOfRange : code == ILF_ABSENT ? Fault::notFound : Fault::device, sentence};
}

std::string tookTooLong(const std::string& what, Second took, Second longest) {
    std::array<char, 160> text{};
    std::snprintf(text.data(), text.size(), "took %.2f s to %s, where %.2f s are allowed", took.si(), what.c_str(),
                  longest.si());
    return text.data();
}

}  // namespace ilf::devices
