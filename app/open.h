// Opening whatever the operator names: a project, a picture, or a video's first frame.
#pragma once

#include <string>

#include "core/base/result.h"
#include "core/document/document.h"
#include "projects/project_file.h"

namespace ilf::app {

/// What came of opening a file. For a picture or video the project is new and untitled.
struct OpenedFile {
    Document document;
    projects::ProjectExtras extras;
    std::string projectPath;  ///< empty: untitled
    std::string videoPath;    ///< set: the scene is the first frame of this video
    std::string note;         ///< what the operator should know of it, or empty
    bool recovered = false;   ///< from an autosave: unsaved from the start
};

/// By content, not by name.
Result<OpenedFile> openAny(const std::string& path);

/// A picture, or a video's first frame, as a scene.
struct OpenedScene {
    Scene scene;
    projects::ProjectExtras extras;
    std::string videoPath;
    std::string note;
};
Result<OpenedScene> openScene(const std::string& path, const projects::ProjectExtras& extras = {});

/// An untitled project over an empty (black) scene.
OpenedFile blankProject();

}  // namespace ilf::app
