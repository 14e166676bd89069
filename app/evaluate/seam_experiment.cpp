#include "app/evaluate/seam_experiment.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "app/evaluate/observers.h"
#include "app/evaluate/scenes.h"
#include "core/base/srgb.h"
#include "core/perceived/perceived.h"
#include "core/perceived/seam_border.h"
#include "projects/pictures.h"
#include "projects/safe_file.h"

namespace ilf::app {
namespace {

constexpr std::array<const char*, 4> kBlendings{"none", "linear-object", "linear-perceived", "closed-form"};
constexpr double kPixelsPerMm = 4.0;
constexpr Metre kSurface = 500.0_mm;
/// Where the reference tables have their main rows.
constexpr Metre kBorderAt = 100.0_mm;
constexpr int kWidest = 600, kHighest = 300;

/// Averaged down to at most kWidest columns, the middle kHighest rows of it.
Picture fitted(const Picture& picture) {
    const int fine = (picture.width() + kWidest - 1) / kWidest;
    const Size size{picture.width() / fine, std::min(kHighest, picture.height() / fine)};
    const int top = (picture.height() / fine - size.height) / 2;
    std::vector<std::uint16_t> pixels;
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            for (int c = 0; c < 3; ++c) {
                long sum = 0;
                for (int v = 0; v < fine; ++v)
                    for (int u = 0; u < fine; ++u)
                        sum += picture.at(x * fine + u, (top + y) * fine + v, c);
                pixels.push_back(static_cast<std::uint16_t>(sum / (fine * fine)));
            }
        }
    }
    return Picture(size, 3, std::move(pixels));
}

Result<Document> experiment(const Picture& picture, bool gap, Dioptre power) {
    const Size size = picture.size();
    const double middle = size.width / 2;
    Document document = scene(picture, 1e3 * kPixelsPerMm * kSurface.si(), {}, Look::focus, kSurface);
    // The optical centre lies to the left: what is blurred on the right moves away from the border.
    document.regions.push_back(
        Box<Region>(strip("blurred", size, gap ? middle : 0.0, gap ? size.width : middle, Look::blur, kSurface)));
    document.wearer.camera = CameraObserver{16.0_mm, 4.0, kSurface, 8.4_um};
    document.wearer.axes = {LensAxis{-kBorderAt, 0.0_m}, LensAxis{-kBorderAt, 0.0_m}};
    document.scene.scale.focalPixels = 1e3 * kPixelsPerMm * (kSurface + document.wearer.lensToPupil).si();
    const auto least = minimumBlurPower(eyeOptics(document.wearer), kSurface);
    if (!least) return tl::unexpected(least.error());
    document.alpha = power - *least;
    return document;
}

Result<SeamExperimentCase> tried(const char* texture, const Picture& picture, bool gap, double power_D) {
    SeamExperimentCase one;
    one.texture = texture;
    one.gap = gap;
    one.power_D = power_D;
    auto document = experiment(picture, gap, Dioptre::fromSi(power_D));
    if (!document) return tl::unexpected(document.error());
    const Radiance plain = plainView(*document, 1.0);
    one.plain = toSrgb8(plain);
    for (std::size_t b = 0; b < kBlendings.size(); ++b) {
        document->seam.blending = static_cast<Blending>(b);
        const auto compiled = played(*document);
        if (!compiled) return tl::unexpected(compiled.error());
        SeamQuestion question;
        question.allBlendings = question.underErrors = false;
        for (const BorderSeam& seam : borderSeams(*compiled, question)) {
            one.light[b] = seam.now[0].weber;
            one.weighted[b] = seam.now[0].weighted;
        }
        const auto seen = perceived(compiled->document, compiled->plan, compiled->program, {});
        if (!seen) return tl::unexpected(seen.error());
        constexpr int kWindow = 5;
        one.measured[b] =
            weberAt(lightAcross(*seen, plain, kWindow), picture.width() / 2, static_cast<int>(15.0 * kPixelsPerMm));
        one.pictures[b] = toSrgb8(*seen);
    }
    return one;
}

/// Cuts of `reach` columns to both sides of the middle, side by side in rows.
Image<std::uint8_t> sheet(const std::vector<std::vector<const Image<std::uint8_t>*>>& rows) {
    constexpr int kReach = 80, kApart = 6;
    const int height = std::min(160, rows.front().front()->height());
    const Size size{static_cast<int>(rows.front().size()) * (2 * kReach + kApart) - kApart,
                    static_cast<int>(rows.size()) * (height + kApart) - kApart};
    std::vector<std::uint8_t> pixels(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height) * 3,
                                     255);
    for (std::size_t r = 0; r < rows.size(); ++r) {
        for (std::size_t c = 0; c < rows[r].size(); ++c) {
            const auto& from = *rows[r][c];
            const int x0 = from.width() / 2 - kReach, y0 = (from.height() - height) / 2;
            for (int y = 0; y < height; ++y) {
                const int row = static_cast<int>(r) * (height + kApart) + y;
                const int column = static_cast<int>(c) * (2 * kReach + kApart);
                std::copy_n(from.row(y0 + y) + 3 * x0, 6 * kReach,
                            pixels.begin() + 3L * (static_cast<long>(row) * size.width + column));
            }
        }
    }
    return Image<std::uint8_t>(size, 3, std::move(pixels));
}

std::string nameOf(const SeamExperimentCase& one) {
    return one.texture + (one.gap ? "-gap-" : "-overlap-") + std::to_string(static_cast<int>(one.power_D)) + "D";
}

}  // namespace

Result<std::vector<SeamExperimentCase>> seamExperiment(const std::string& folder) {
    constexpr std::pair<const char*, const char*> kTextures[] = {{"text", "opencv/imageTextN.png"},
                                                                 {"painting", "wuffs/harvesters.jpeg"}};
    std::vector<SeamExperimentCase> cases;
    for (const auto& [texture, file] : kTextures) {
        const auto picture = projects::readPicture(std::filesystem::path(folder) / file);
        if (!picture) return tl::unexpected(picture.error());
        const Picture surface = fitted(picture->picture);
        for (const bool gap : {true, false}) {
            for (const double power : {1.0, 2.0}) {
                auto one = tried(texture, surface, gap, power);
                if (!one) return tl::unexpected(one.error());
                cases.push_back(*std::move(one));
            }
        }
    }
    return cases;
}

Result<std::string> writeSeamExperiment(const std::string& folder, const std::vector<SeamExperimentCase>& cases) {
    const std::filesystem::path out(folder);
    if (const auto made = projects::makeFolders(out); !made) return tl::unexpected(made.error());
    std::string csv = "texture,side,power_D,blending,weber_light,weber_light_csf,weber_picture\n";
    std::string table = "Worst Weber contrast (even light, weighted, from the picture), in percent. Simulated.\n";
    for (const SeamExperimentCase& one : cases) {
        if (const auto put = projects::writePng(out / (nameOf(one) + "-plain.png"), one.plain); !put)
            return tl::unexpected(put.error());
        for (std::size_t b = 0; b < kBlendings.size(); ++b) {
            const auto put = projects::writePng(out / (nameOf(one) + "-" + kBlendings[b] + ".png"), one.pictures[b]);
            if (!put) return tl::unexpected(put.error());
            std::array<char, 160> line{};
            std::snprintf(line.data(), line.size(), "%s,%s,%g,%s,%.5f,%.5f,%.5f\n", one.texture.c_str(),
                          one.gap ? "gap" : "overlap", one.power_D, kBlendings[b], one.light[b], one.weighted[b],
                          one.measured[b]);
            csv += line.data();
            std::snprintf(line.data(), line.size(), "%-8s %-7s %g D  %-16s %7.2f %7.2f %+8.2f\n", one.texture.c_str(),
                          one.gap ? "gap" : "overlap", one.power_D, kBlendings[b], 100.0 * one.light[b],
                          100.0 * one.weighted[b], 100.0 * one.measured[b]);
            table += line.data();
        }
    }
    for (std::size_t first = 0; first < cases.size();) {
        std::size_t last = first;
        std::vector<std::vector<const Image<std::uint8_t>*>> rows(kBlendings.size());
        for (; last < cases.size() && cases[last].texture == cases[first].texture; ++last) {
            for (std::size_t b = 0; b < rows.size(); ++b)
                rows[b].push_back(&cases[last].pictures[b]);
        }
        const auto put = projects::writePng(out / (cases[first].texture + "-sheet.png"), sheet(rows));
        if (!put) return tl::unexpected(put.error());
        first = last;
    }
    if (const auto put = projects::writeAtomically(out / "seams.csv", csv); !put) return tl::unexpected(put.error());
    return table + (out / "seams.csv").string() + '\n';
}

}  // namespace ilf::app
