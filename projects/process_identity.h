// Which process wrote something, told apart from later ones of the same number.
#pragma once

#include "projects/json.h"

namespace ilf::projects {

/// Process id, start time and boot of this process, as keys of `json`.
void signWithProcess(Json& json);
/// True while the process that signed runs.
bool signerLives(const Json& json);
/// True for this process itself.
bool signedByMe(const Json& json);

}  // namespace ilf::projects
