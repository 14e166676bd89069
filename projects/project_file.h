// Projects in files: a folder NAME.ilfd, or the same tree zipped as NAME.ilf, saved whole or not at all.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/document/document.h"
#include "projects/pictures.h"

namespace ilf::projects {

/// What a project's files hold besides the document: keys and files this version does not know, the picture's file as
/// it was, masks already encoded. A value to keep beside the document and to hand back when saving; a default one is
/// right for a new document. Cheap to copy, may be used from any thread.
class ProjectExtras {
public:
    ProjectExtras();
    /// Saving keeps this picture's file byte for byte while the document shows its picture. Also after undo, redo.
    ProjectExtras withOriginal(const PictureFile& file) const;

    struct State;
    explicit ProjectExtras(std::shared_ptr<const State> state) : state_(std::move(state)) {}
    const State& state() const { return *state_; }

private:
    std::shared_ptr<const State> state_;
};

struct OpenedProject {
    Document document;
    ProjectExtras extras;
};

/// Opens a folder or an archive, told by content; `project.json` inside a folder stands for the folder. Refused with a
/// sentence: not a project, a newer version, damaged text (line and column), a missing file (named), a mask or depth
/// map of another size than the picture, numbers out of range, names that lead out of the project.
Result<OpenedProject> openProject(const std::filesystem::path& path);

enum class Backups {
    keep,  ///< what is replaced is kept in NAME.ilfd.backups beside the project, the newest five
    none,
};

/// Files in a project's folder that are not ours: notes, captures, .git.
enum class OtherFiles {
    carry,  ///< they stay with the project, and go along to another place (hidden ones do not)
    leave,
};

/// Saves as a folder (path ends in .ilfd) or an archive (.ilf). The whole new tree is written beside the old one, made
/// durable, then put in its place in one step: whichever step fails, the project on disk is the old one or the new one.
/// Never replaces a folder that is not a project. Gives the extras to save with the next time.
Result<ProjectExtras> saveProject(const std::filesystem::path& path, const Document& document,
                                  const ProjectExtras& extras, Backups backups = Backups::keep,
                                  OtherFiles otherFiles = OtherFiles::carry);

/// Backups of the project at `path`, newest first; each opens like a project.
std::vector<std::filesystem::path> backupsOf(const std::filesystem::path& path);

}  // namespace ilf::projects
