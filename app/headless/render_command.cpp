#include "app/headless/render_command.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iostream>
#include <set>

#include "app/exit_code.h"
#include "app/headless/prepare.h"
#include "app/headless/render_progress.h"
#include "app/headless/render_view.h"
#include "projects/picture_export.h"
#include "projects/safe_file.h"

namespace ilf::app {
namespace {

namespace fs = std::filesystem;
using projects::PictureFormat;

/// What was asked and cannot be had is a matter of usage; the rest keeps its own code.
int codeOf(const Error& error) { return error.fault == Fault::outOfRange ? kUsage : exitCode(error); }

/// What a project's pictures in the folder are called: its name without the ending.
std::string stemOf(const std::string& file) {
    fs::path path = fs::path(file).lexically_normal();
    if (!path.has_filename()) path = path.parent_path();
    return path.stem().string();
}

/// Two projects of one name must not write over each other: "desk", "desk-2".
std::vector<std::string> distinctStems(const std::vector<std::string>& files) {
    std::vector<std::string> stems;
    for (const std::string& file : files) {
        const std::string stem = stemOf(file);
        std::string free = stem;
        for (int i = 2; std::find(stems.begin(), stems.end(), free) != stems.end(); ++i)
            free = stem + "-" + std::to_string(i);
        stems.push_back(free);
    }
    return stems;
}

/// A rendering of everything that was asked, which goes on after what fails.
class Batch {
public:
    explicit Batch(const RenderOptions& options)
        : options_(options), progress_(std::cerr, options.outDir.empty() ? 0 : terminalWidth()) {}

    int run() {
        const std::vector<std::string> stems = distinctStems(options_.files);
        for (std::size_t i = 0; i < options_.files.size(); ++i)
            project(options_.files[i], stems[i], i);
        progress_.cleared();
        if (!options_.outDir.empty() || failed_ + written_ > 1) summarise();
        return codes_.empty() ? kDone : codes_.size() == 1 ? *codes_.begin() : kFailed;
    }

private:
    void project(const std::string& file, const std::string& stem, std::size_t index) {
        const auto step = [&](double part, const std::string& doing) {
            progress_.show((static_cast<double>(index) + part) / static_cast<double>(options_.files.size()), doing);
        };
        step(0.0, file);
        const auto prepared = app::prepared(file, options_.rig);
        if (!prepared) return failure(file, prepared.error(), exitCode(prepared.error()));
        const Compiled& compiled = prepared->compiled;
        const auto shots = shotsOf(options_, static_cast<int>(compiled.program.imageOfSlot.size()));
        if (!shots) return failure(file, shots.error(), codeOf(shots.error()));
        if (options_.chromatic && !compiled.document.rig.primaries) {
            progress_.cleared();
            std::cerr << "illuminatedfocus render: the rig of " << file
                      << " does not say its projector's wavelengths (\"primaries_nm\"), so --chromatic keeps colours "
                         "together.\n";
        }
        const auto named = options_.outDir.empty() ? filesFor(options_.out, *shots) : std::vector<std::string>();
        for (std::size_t k = 0; k < shots->size(); ++k) {
            step(static_cast<double>(k) / static_cast<double>(shots->size()), stem + ": " + nameOf((*shots)[k]));
            const auto picture = rendered(compiled, (*shots)[k], options_);
            if (!picture) {
                failure(file, picture.error(), codeOf(picture.error()));
            } else if (options_.outDir.empty()) {
                write(file, named[k], *picture);
            } else {
                for (const std::string& format : options_.formats)
                    write(file,
                          (fs::path(options_.outDir) / (stem + "-" + nameOf((*shots)[k]) + "." + format)).string(),
                          *picture);
            }
        }
    }

    void write(const std::string& file, const std::string& path, const Rendered& picture) {
        const auto depth = options_.half ? projects::ExrDepth::half : projects::ExrDepth::single;
        const auto done = projects::pictureFormat(path).and_then([&](PictureFormat format) {
            return projects::writeExport(path, picture.pixels, picture.facts, format, depth);
        });
        if (!done) return failure(file, done.error(), exitCode(done.error()));
        ++written_;
        progress_.cleared();
        std::cout << path << ": " << picture.spoken << '\n';
        if (!picture.figures.empty()) std::cout << "  " << picture.figures << '\n';
        std::cout.flush();
    }

    void failure(const std::string& file, const Error& error, int code) {
        ++failed_;
        codes_.insert(code);
        progress_.cleared();
        const bool named = options_.files.size() == 1 || error.what.find(stemOf(file)) != std::string::npos;
        refused("render", named ? error : Error{error.fault, file + ": " + error.what});
    }

    void summarise() const {
        std::cout << written_ << (written_ == 1 ? " picture" : " pictures") << " written";
        if (!options_.outDir.empty()) std::cout << " to " << options_.outDir;
        if (failed_ > 0) std::cout << ", " << failed_ << " failed";
        std::cout << ".\n";
    }

    const RenderOptions& options_;
    RenderProgress progress_;
    int written_ = 0, failed_ = 0;
    std::set<int> codes_;  ///< of what failed
};

/// What is wrong with the options themselves, before anything is opened.
Result<void> checked(const RenderOptions& options) {
    if (auto known = checkedViews(options.views); !known) return known;
    if (options.out.empty() && options.outDir.empty()) {
        return fail(Fault::outOfRange, "say where to: -o FILE for one project, --out-dir DIR for several.");
    }
    if (!options.outDir.empty()) return {};
    if (options.files.size() > 1) {
        return fail(Fault::outOfRange, "several projects need --out-dir DIR instead of -o.");
    }
    if (auto format = projects::pictureFormat(options.out); !format) return tl::unexpected(format.error());
    return {};
}

}  // namespace

int renderCommand(const RenderOptions& asked) {
    RenderOptions options = asked;
    if (options.formats.empty()) options.formats = {"png"};
    if (const auto good = checked(options); !good) {
        refused("render", good.error());
        return kUsage;
    }
    if (!options.outDir.empty()) {
        if (const auto made = projects::makeFolders(options.outDir); !made) return refused("render", made.error());
    }
    return Batch(options).run();
}

}  // namespace ilf::app
