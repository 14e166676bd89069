// The words files and command lines use for looks, eyes, circles of confusion and times.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/document/document.h"

namespace ilf::app {

inline const char* word(Look look) {
    switch (look) {
    case Look::focus:
        return "focus";
    case Look::blur:
        return "blur";
    case Look::neutral:
        return "neutral";
    }
    return "focus";
}

/// A number that is the whole of `text`, with a decimal point whatever the locale.
std::optional<double> wholeNumber(std::string_view text);

/// This moment as files say it: "2026-11-22T23:19:27Z".
std::string utcNow();

Result<Look> lookFromWord(std::string_view text);
/// 1arcmin, dof, landolt, or a diameter on the retina in metres.
Result<CircleOfConfusion> confusionFromWord(const std::string& text);

}  // namespace ilf::app
