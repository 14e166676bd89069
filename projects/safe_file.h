// Files written so that a crash or a full disk leaves the old file or the new one, never half of one.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace ilf::projects {

namespace fs = std::filesystem;

/// A path as sentences show it.
std::string spoken(const fs::path& path);

/// The whole file. Refused with a sentence: missing, a directory, not a plain file, more than `maxBytes`, unreadable.
Result<std::string> readWhole(const fs::path& path, std::size_t maxBytes);

/// Writes beside `path` (temporary file, fsync), then renames over it and fsyncs the folder.
Result<void> writeAtomically(const fs::path& path, std::string_view bytes);

/// A new file with that content, fsynced. Refuses to overwrite. Not atomic by itself: for files inside a folder that is
/// put in place as a whole.
Result<void> writeNew(const fs::path& path, std::string_view bytes);
/// The file or folder tree at `from` appears at `to` as well: by hard links where the file system has them (nobody here
/// writes into an existing file, so shared content stays what it was), by copying where not.
Result<void> linkTree(const fs::path& from, const fs::path& to);
/// Creates a folder and those above it.
Result<void> makeFolders(const fs::path& path);
/// Makes the folder's entries durable.
Result<void> syncFolder(const fs::path& path);
/// Puts `fresh` (a complete file or folder tree) in the place of `target` in one step. What was at `target`, if
/// anything, is then at the returned path (empty when there was nothing, or when a file was simply replaced).
Result<fs::path> putInPlace(const fs::path& fresh, const fs::path& target);
/// Removes a tree of ours; leftovers harm nobody, so failures are not reported.
void removeQuietly(const fs::path& path);
/// A name in the folder of `path` that is not in use, hidden, telling the process.
fs::path siblingOf(const fs::path& path, std::string_view purpose);

/// For tests: how a disk fails.
enum class Failing {
    fullDisk,    ///< only the chosen step fails; tidying up works
    powerFails,  ///< the chosen step and every later one fail, tidying up included
};
/// For tests: while it lives, the `step`-th step of writing (1, 2, ...) in this thread fails.
class FailAt {
public:
    FailAt(int step, Failing how);
    ~FailAt();
    FailAt(const FailAt&) = delete;
    FailAt& operator=(const FailAt&) = delete;
    /// False when the scenario ended before it came to that step.
    bool reached() const;
};

}  // namespace ilf::projects
