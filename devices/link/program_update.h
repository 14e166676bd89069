// A program as differences from another, and back: what makes a brush dab cost kilobytes instead of megabytes.
#pragma once

#include "devices/link/messages.h"

namespace ilf::devices {

/// What must be sent so that a receiver who has `base` (or nothing) gets `program`. `hash` is contentHash(program),
/// `baseHash` that of the base. Tiles that share their box cost one pointer comparison. Images of a base of another
/// size are of no use and are sent whole.
ProgramUpdate difference(const Program& program, std::uint64_t hash, const Program* base = nullptr,
                         std::uint64_t baseHash = 0);

/// The whole program. Tiles that did not change share their boxes with `base`. Refuses an update whose base is another
/// program, tiles that do not fit, and a result whose content hash is not the announced one.
Result<Program> assembled(const ProgramUpdate& update, const Program* base = nullptr, std::uint64_t baseHash = 0);

/// True if `update` needs a base and this is not it: the sender should send the whole program.
bool needsAnotherBase(const ProgramUpdate& update, const Program* base, std::uint64_t baseHash);

}  // namespace ilf::devices
