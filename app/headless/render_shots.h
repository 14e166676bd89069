// Which pictures of a project are asked for, by the words of the command line.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/headless/render_command.h"
#include "core/perceived/perceived.h"

namespace ilf::app {

/// One picture of a project.
struct Shot {
    std::string view;         ///< perceived, error, plain, camera, overlay, slot
    std::optional<Eye> eye;   ///< of perceived and error
    std::optional<int> slot;  ///< of slot
    bool operator==(const Shot&) const = default;
};

/// Refuses words that are no view, before any file is opened.
Result<void> checkedViews(const std::vector<std::string>& views);

/// The pictures `options` ask of a project whose sweep has `slots` slots, in the order asked. Refused: a slot that does
/// not exist.
Result<std::vector<Shot>> shotsOf(const RenderOptions& options, int slots);

/// "perceived-left", "overlay", "slot-03".
std::string nameOf(const Shot& shot);

/// Where each shot goes: `out` itself for one alone; for several, what tells them apart is put before its ending
/// ("seen-left.png", "slots-03.png"; with several views "seen-perceived-left.png").
std::vector<std::string> filesFor(const std::string& out, const std::vector<Shot>& shots);

/// What the options ask of the view. Refused: a region the document does not have, or has twice, and a gaze that is no
/// point of the picture.
Result<ViewRequest> requestOf(const RenderOptions& options, const Document& document, Eye eye);

}  // namespace ilf::app
