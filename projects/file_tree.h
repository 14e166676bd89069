// A project's files by name, from a folder or from the same folder zipped.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/base/box.h"
#include "core/base/result.h"

namespace ilf::projects {

/// Names are relative, with '/' between folders ("masks/face.png").
class FileTree {
public:
    virtual ~FileTree() = default;
    /// Refused with a sentence: not there, larger than 1 GB, damaged, or a name that leads out of the tree.
    virtual Result<std::string> read(const std::string& name) const = 0;
    virtual std::vector<std::string> names() const = 0;
    virtual bool zipped() const = 0;
    /// How sentences call the file.
    std::string spokenName(const std::string& name) const;

protected:
    explicit FileTree(std::filesystem::path path) : path_(std::move(path)) {}
    std::filesystem::path path_;
};

/// The folder or zip archive at `path`, told by content. In an archive the tree may lie inside one folder, as archives
/// made by hand have it; `marker` is the file that shows where. Archives with names that lead out of them are refused.
Result<std::unique_ptr<FileTree>> openTree(const std::filesystem::path& path, const std::string& marker);

/// False for absolute names, "..", backslashes and control characters.
bool staysInside(const std::string& name);

struct TreeFile {
    std::string name;
    Box<std::string> bytes;
};
/// Writes a new folder or archive of these files at `path`, which must not exist, and makes it durable.
Result<void> writeFolder(const std::filesystem::path& path, const std::vector<TreeFile>& files);
Result<void> writeZip(const std::filesystem::path& path, const std::vector<TreeFile>& files);

}  // namespace ilf::projects
