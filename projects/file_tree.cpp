#include "projects/file_tree.h"

#include <zip.h>

#include <algorithm>
#include <set>

#include "projects/safe_file.h"

namespace ilf::projects {
namespace {

constexpr std::size_t kMaxFileBytes = std::size_t{1} << 30;

Result<void> checkedName(const FileTree& tree, const std::string& name) {
    if (staysInside(name)) return {};
    return fail(Fault::badFile, tree.spokenName("project.json") + " names a file outside the project: \"" + name +
                                    "\". Only files inside it can be used.");
}

class Folder : public FileTree {
public:
    explicit Folder(fs::path path) : FileTree(std::move(path)) {}

    Result<std::string> read(const std::string& name) const override {
        if (auto inside = checkedName(*this, name); !inside) return tl::unexpected(inside.error());
        return readWhole(path_ / name, kMaxFileBytes);
    }
    std::vector<std::string> names() const override {
        std::vector<std::string> names;
        std::error_code error;
        for (fs::recursive_directory_iterator at(path_, error), end; !error && at != end; at.increment(error)) {
            std::error_code gone;
            if (at->is_regular_file(gone)) names.push_back(at->path().lexically_relative(path_).generic_string());
        }
        return names;
    }
    bool zipped() const override { return false; }
};

struct CloseZip {
    void operator()(zip_t* archive) const { zip_discard(archive); }
};
using Zip = std::unique_ptr<zip_t, CloseZip>;

std::string zipWords(int code) {
    zip_error_t error;
    zip_error_init_with_code(&error, code);
    std::string words = zip_error_strerror(&error);
    zip_error_fini(&error);
    return words;
}

class Archive : public FileTree {
public:
    Archive(fs::path path, Zip zip, std::string prefix)
        : FileTree(std::move(path)), zip_(std::move(zip)), prefix_(std::move(prefix)) {}

    Result<std::string> read(const std::string& name) const override {
        if (auto inside = checkedName(*this, name); !inside) return tl::unexpected(inside.error());
        zip_stat_t info;
        const std::string full = prefix_ + name;
        if (zip_stat(zip_.get(), full.c_str(), 0, &info) != 0) {
            return fail(Fault::notFound, spokenName(name) + " does not exist. Take a backup of the project.");
        }
        if (info.size > kMaxFileBytes) return fail(Fault::badFile, spokenName(name) + " is larger than 1 GB.");
        const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> file(zip_fopen_index(zip_.get(), info.index, 0),
                                                                     zip_fclose);
        if (!file) return damaged(name);
        // The size in the directory is only a claim: memory is taken as bytes really come.
        std::string bytes;
        std::string part(std::size_t{1} << 16, '\0');
        for (;;) {
            const zip_int64_t n = zip_fread(file.get(), part.data(), part.size());
            if (n < 0) return damaged(name);
            if (n == 0) break;
            bytes.append(part, 0, static_cast<std::size_t>(n));
            if (bytes.size() > kMaxFileBytes) return damaged(name);
        }
        if (bytes.size() != info.size) return damaged(name);
        return bytes;
    }
    std::vector<std::string> names() const override {
        std::vector<std::string> names;
        const zip_int64_t count = zip_get_num_entries(zip_.get(), 0);
        for (zip_int64_t i = 0; i < count; ++i) {
            const char* raw = zip_get_name(zip_.get(), static_cast<zip_uint64_t>(i), 0);
            const std::string name = raw != nullptr ? raw : "";
            if (name.starts_with(prefix_) && !name.ends_with('/')) names.push_back(name.substr(prefix_.size()));
        }
        return names;
    }
    bool zipped() const override { return true; }

private:
    tl::unexpected<Error> damaged(const std::string& name) const {
        return fail(Fault::badFile, spokenName(name) + " is damaged inside the archive. Take a backup of the project.");
    }
    Zip zip_;
    std::string prefix_;
};

Result<std::unique_ptr<FileTree>> openArchive(const fs::path& path, const std::string& marker) {
    int code = 0;
    Zip zip(zip_open(path.c_str(), ZIP_RDONLY, &code));
    if (!zip) {
        return fail(Fault::badFile, spoken(path) + " is not a project, or it is damaged (" + zipWords(code) +
                                        "). Take a backup, or copy it again.");
    }
    std::string prefix;
    bool found = false;
    const zip_int64_t count = zip_get_num_entries(zip.get(), 0);
    for (zip_int64_t i = 0; i < count; ++i) {
        const char* raw = zip_get_name(zip.get(), static_cast<zip_uint64_t>(i), 0);
        const std::string name = raw != nullptr ? raw : "";
        const std::string plain = name.ends_with('/') ? name.substr(0, name.size() - 1) : name;
        if (!staysInside(plain)) {
            return fail(Fault::badFile, spoken(path) + " holds a file whose name leads out of it (\"" + name +
                                            "\"). Such archives are not opened.");
        }
        const bool isMarker = name == marker || name.ends_with("/" + marker);
        const std::string before = isMarker ? name.substr(0, name.size() - marker.size()) : "";
        if (isMarker && (!found || before.size() < prefix.size())) {
            prefix = before;
            found = true;
        }
    }
    if (!found)
        return fail(Fault::badFile, spoken(path) + " is an archive without a project: it has no " + marker + ".");
    return std::make_unique<Archive>(path, std::move(zip), prefix);
}

}  // namespace

std::string FileTree::spokenName(const std::string& name) const { return spoken(path_ / name); }

bool staysInside(const std::string& name) {
    if (name.empty() || name.front() == '/' || name.size() > 1000) return false;
    const bool odd = std::any_of(name.begin(), name.end(),
                                 [](char c) { return c == '\\' || static_cast<unsigned char>(c) < 0x20 || c == 0x7F; });
    if (odd || name.find(':') == 1) return false;
    for (const fs::path& part : fs::path(name)) {
        if (part == ".." || part == "." || part.empty()) return false;
    }
    return true;
}

Result<std::unique_ptr<FileTree>> openTree(const fs::path& path, const std::string& marker) {
    std::error_code error;
    if (fs::is_directory(path, error)) {
        if (!fs::exists(path / marker, error)) {
            return fail(Fault::badFile, spoken(path) + " is a folder, but not a project: it has no " + marker + ".");
        }
        return std::make_unique<Folder>(path);
    }
    if (!fs::exists(path, error)) {
        return fail(Fault::notFound, spoken(path) + " does not exist. Check the name, or where it was moved to.");
    }
    return openArchive(path, marker);
}

Result<void> writeFolder(const fs::path& path, const std::vector<TreeFile>& files) {
    if (auto made = makeFolders(path); !made) return made;
    std::set<fs::path> folders{path};
    for (const TreeFile& file : files) {
        const fs::path folder = (path / file.name).parent_path();
        if (folders.insert(folder).second) {
            if (auto made = makeFolders(folder); !made) return made;
        }
        if (auto written = writeNew(path / file.name, *file.bytes); !written) return written;
    }
    for (const fs::path& folder : folders) {
        if (auto synced = syncFolder(folder); !synced) return synced;
    }
    return {};
}

Result<void> writeZip(const fs::path& path, const std::vector<TreeFile>& files) {
    // The archive is made in memory, so that the disk is written in the same careful steps as everywhere else.
    zip_error_t error;
    zip_error_init(&error);
    zip_source_t* whole = zip_source_buffer_create(nullptr, 0, 0, &error);
    if (whole == nullptr) return fail(Fault::cannotWrite, spoken(path) + " cannot be zipped: out of memory.");
    zip_t* archive = zip_open_from_source(whole, ZIP_CREATE | ZIP_TRUNCATE, &error);
    const auto refused = [&] {
        return fail(Fault::cannotWrite, spoken(path) + " cannot be zipped: " + zip_error_strerror(&error) + ".");
    };
    if (archive == nullptr) {
        zip_source_free(whole);
        return refused();
    }
    zip_source_keep(whole);
    bool well = true;
    for (const TreeFile& file : files) {
        zip_source_t* source = zip_source_buffer(archive, file.bytes->data(), file.bytes->size(), 0);
        const zip_int64_t index =
            source == nullptr ? -1 : zip_file_add(archive, file.name.c_str(), source, ZIP_FL_ENC_UTF_8);
        if (index < 0) {
            zip_source_free(source);
            well = false;
            break;
        }
        // Pictures are compressed already.
        if (!file.name.ends_with(".json")) {
            zip_set_file_compression(archive, static_cast<zip_uint64_t>(index), ZIP_CM_STORE, 0);
        }
    }
    if (!well || zip_close(archive) != 0) {
        zip_error_set(&error, zip_error_code_zip(zip_get_error(archive)), 0);
        zip_discard(archive);
        zip_source_free(whole);
        return refused();
    }
    std::string bytes;
    zip_stat_t info;
    zip_stat_init(&info);
    well = zip_source_open(whole) == 0 && zip_source_stat(whole, &info) == 0;
    if (well) {
        bytes.resize(info.size);
        well = zip_source_read(whole, bytes.data(), bytes.size()) == static_cast<zip_int64_t>(bytes.size());
        zip_source_close(whole);
    }
    zip_source_free(whole);
    return well ? writeNew(path, bytes) : Result<void>(refused());
}

}  // namespace ilf::projects
