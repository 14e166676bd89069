#include <CLI/CLI.hpp>

#include "app/headless/render_command.h"

namespace ilf::app {

CLI::App& addRender(CLI::App& app, RenderOptions& options) {
    auto* render = app.add_subcommand("render", "Views of projects as pictures: PNG, 16-bit TIFF or EXR");
    render->add_option("FILE", options.files, "Projects, pictures or videos; several with --out-dir")->required();
    render
        ->add_option("--view,--views", options.views,
                     "perceived, error (against --reference's rays), plain, camera, overlay, slots, slot:N; several "
                     "with commas between them")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->capture_default_str();
    render->add_option("--eye,--eyes", options.eye, "left, right or both")
        ->check(CLI::IsMember({"left", "right", "both"}))
        ->capture_default_str();
    render->add_option("--rung", options.rung, "How carefully: dragging, rest or idle")
        ->check(CLI::IsMember({"dragging", "rest", "idle"}))
        ->capture_default_str();
    render->add_option("--attend", options.attend, "Region the eye accommodates to (otherwise the nearest in focus)");
    render->add_option("--gaze", options.gaze, "ahead, follows (every point in turn) or X,Y in the picture's pixels")
        ->capture_default_str();
    render->add_flag("--chromatic", options.chromatic, "Red, green and blue each in the focus the eye has for them");
    render->add_flag("--lens-field", options.lensField, "What lies beyond the lens's rim is seen past it");
    render->add_option("--scale", options.scale, "Pixels of the view for each of the picture")
        ->check(CLI::Range(0.01, 1.0))
        ->capture_default_str();
    render->add_flag("--reference", options.reference, "Perceived view by brute force: rays through the pupil; slow");
    render->add_option("--samples", options.samples, "Rays a pixel of the reference")
        ->check(CLI::Range(2, 65536))
        ->capture_default_str();
    render->add_option("--white", options.white, "Difference that --view error shows white (otherwise its largest)")
        ->check(CLI::Range(1e-6, 1e3));
    render->add_flag("--half", options.half, "EXR of 16-bit floats instead of 32");
    auto* out = render->add_option("-o,--out", options.out,
                                   "File to write: .png (8-bit sRGB), .tif (16-bit sRGB) or .exr (linear light); with "
                                   "several views or eyes each name says which");
    auto* folder = render->add_option("--out-dir", options.outDir, "Folder to write into instead")->excludes(out);
    render->add_option("--format,--formats", options.formats, "In that folder: png, tif, exr, with commas")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::IsMember({"png", "tif", "exr"}))
        ->needs(folder);
    return *render;
}

}  // namespace ilf::app
