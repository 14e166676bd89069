// The sample scenes, one function each.
#pragma once

#include "scene.h"

namespace ilf::samples {

Scene museumGuide();
Scene studyDesk();
Scene tutorialRecording();
Scene fourObjects();

}  // namespace ilf::samples
