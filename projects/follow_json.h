// What a region follows, to JSON and back.
#pragma once

#include "core/document/follow.h"
#include "projects/json.h"

namespace ilf::projects {

/// `before` is what the file held: the keys this version does not know are kept.
Json written(const Follow& follow, Json before);
Follow followFrom(JsonReader reader);

}  // namespace ilf::projects
