// How a setting is told to a LightCrafter and compared with what the board then says.
#pragma once

#include "devices/dlpc350/lightcrafter.h"

namespace ilf::devices::dlpc350 {

template <class T>
Error mismatch(const std::string& name, const T& told, const T& found) {
    return {Fault::device, name + " was told " + kCommandOf<T>.name + " \"" + inWords(told) + "\" but says \"" +
                               inWords(found) + "\". Switch its power off and on, and check its firmware."};
}

template <class T>
Result<void> LightCrafter::set(const T& value) {
    if (const auto ok = board_.tell(kCommandOf<T>, payloadOf(value)); !ok) return ok;
    const auto found = board_.ask<T>();
    if (!found) return tl::unexpected(found.error());
    if (*found != value) return tl::unexpected(mismatch(name(), value, *found));
    return {};
}

template <class T>
Result<void> LightCrafter::madeSure(const T& value) {
    const auto found = board_.ask<T>();
    return found && *found == value ? Result<void>{} : set(value);
}

}  // namespace ilf::devices::dlpc350
