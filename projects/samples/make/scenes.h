// The sample scenes, one function each.
#pragma once

#include "scene.h"

namespace ilf::samples {

Scene museumGuide();
Scene studyDesk();
Scene tutorialRecording();
Scene fourObjects();
/// The study desk in a smaller picture, for a camera that scans it.
Scene scannedDesk();

}  // namespace ilf::samples
