#include "app/scan/kept_pictures.h"

#include <cstdio>
#include <system_error>

#include "projects/pictures.h"

namespace ilf::app {

Result<void> keepPictures(const std::filesystem::path& folder, const Scan& scan) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        return fail(Fault::cannotWrite, "The folder " + folder.string() +
                                            " for the scan's pictures cannot be made: " + error.message() + ".");
    for (std::size_t i = 0; i < scan.pictures.size(); ++i) {
        char name[32];
        std::snprintf(name, sizeof name, "%02zu.png", i);
        if (const auto written = projects::writePng(folder / name, scan.pictures[i]); !written) return written;
    }
    return {};
}

}  // namespace ilf::app
