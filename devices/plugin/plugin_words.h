// What plugins say, made fit for an operator's eyes, and the sentences made of it.
#pragma once

#include <cstddef>
#include <string>

#include "core/base/quantity.h"
#include "core/base/result.h"
#include "devices/plugin/illuminatedfocus_projector.h"

namespace ilf::devices {

/// The text up to its 0 byte, or all `most` bytes; control characters become spaces, and what is no UTF-8 question
/// marks.
std::string pluginText(const char* text, std::size_t most);

/// The sentence for a call that returned `code`, and what would help. "what" completes "could not ...".
Error pluginError(const std::string& plugin, const std::string& what, ilf_code code, const ilf_message& message);

/// "took 0.90 s to upload a slot's picture, where 0.25 s are allowed"
std::string tookTooLong(const std::string& what, Second took, Second longest);

}  // namespace ilf::devices
