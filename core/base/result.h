// A value, or one sentence for the operator that says why there is none.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace ilf {

/// What kind of refusal an error is; it chooses exit codes and icons, never the words.
enum class Fault {
    outOfRange,   ///< a number or choice that cannot be used
    notFound,     ///< a region, file or device that is not there
    badFile,      ///< a file or message whose content is not what it claims to be
    cannotWrite,  ///< the disk or socket refused
    device,       ///< a lens, projector, camera or their link failed
    unsafe,       ///< a plan that would harm eyes, lens or the promise of steady light
    unsupported,  ///< understood, but not something this version can do
};

/// Why something was refused. `what` is one sentence for the operator: what, where, and what would help.
struct Error {
    Fault fault = Fault::outOfRange;
    std::string what;
    bool operator==(const Error&) const = default;
};

template <class T>
using Result = tl::expected<T, Error>;

inline tl::unexpected<Error> fail(Fault fault, std::string what) {
    return tl::unexpected<Error>(Error{fault, std::move(what)});
}

}  // namespace ilf
