// illuminatedfocus: the studio, and the same job without a display.
#include <CLI/CLI.hpp>
#include <iostream>

#include "app/emulated_scenes.h"
#include "app/exit_code.h"
#include "app/headless/calibrate_command.h"
#include "app/headless/decode_scan_command.h"
#include "app/headless/doctor_command.h"
#include "app/headless/evaluate_command.h"
#include "app/headless/gltf_command.h"
#include "app/headless/lens_command.h"
#include "app/headless/measure_command.h"
#include "app/headless/optics_command.h"
#include "app/headless/plan_command.h"
#include "app/headless/render_command.h"
#include "app/headless/run_command.h"
#include "app/headless/scan_command.h"
#include "app/headless/seams_command.h"
#include "app/headless/track_command.h"
#include "app/headless/validate_command.h"
#include "app/studio/options.h"
#include "devices/link/start_core.h"
#include "ilf/version.h"
#include "ui/commands.h"

namespace {

using namespace ilf::app;

constexpr const char* kFooter =
    "Exit codes: 0 done, 1 failed, 2 usage, 3 device, 4 unsafe plan.\n"
    "Light and lens are simulated, or emulated (--rig emulated); hardware plays only with --rig FILE.\n"
    "Its drivers were tested against emulators written from the public protocols, never on hardware (see doctor).";

const std::vector<std::string> kSimulatedLenses{"slow", "datasheet", "lively", "clean", "dirty", "ideal"};

/// Of the window as well.
void addRig(CLI::App& command, RigChoice& choice) {
    command.add_option("--rig", choice.rig,
                       "Instead of the document's: simulated, emulated (drivers of real devices over emulated cables) "
                       "or a rig's file");
    command.add_option("--bits", choice.bits, "Of a slot's picture, with as many slots as the projector then shows")
        ->check(CLI::Range(1, 8));
    command
        .add_option("--simulated-lens", choice.simulated,
                    "Of a core that has to be started: slow, datasheet, lively, clean, dirty, ideal")
        ->check(CLI::IsMember(kSimulatedLenses));
}

void addRigChoice(CLI::App& command, RigChoice& choice) {
    addRig(command, choice);
    command
        .add_option("--wave", choice.waves, "Instead of the rig's: continuous, shaped, slot-aware, paper, ideal-sine")
        ->check(CLI::IsMember({"continuous", "shaped", "slot-aware", "paper", "ideal-sine"}));
    command.add_option("--lens", choice.file, "Calibration of the lens, instead of the rig's");
}

void addPlan(CLI::App& app, PlanOptions& options) {
    auto* plan = app.add_subcommand("plan", "What the lens must do: sweep, levels, slots, and what cannot be blurred");
    plan->add_option("FILE", options.file, "Project, picture or video");
    plan->add_option("--object", options.objects, "NAME,DISTANCE_M,focus|blur|neutral; instead of FILE, repeatable")
        ->allow_extra_args(false);
    plan->add_option("--alpha", options.alpha_D, "Added to P_s, in dioptres");
    plan->add_option("--coc", options.coc, "Circle of confusion: 1arcmin, dof, landolt, or metres on the retina");
    plan->add_flag("--json", options.json, "As JSON");
    addRigChoice(*plan, options.rig);
}

void addRun(CLI::App& app, RunOptions& options) {
    auto* run = app.add_subcommand("run", "Plan, compile and play on a core of its own, then read back what it showed");
    run->footer(
        "With --rig emulated, intended light and lens are compared with what the cables brought, pixel by pixel: the\n"
        "exit code is 3 where they differ (what the rig's bits leave is stated and no difference). Mishaps:\n"
        "projector or lenses: nack, silence, stall, unplug, wrong-mode, underrun, over-temperature,\n"
        "dropped-trigger, clock-drift, stuck-frame, plug, none; display: unplug, plug.");
    run->add_option("FILE", options.file, "Project, picture or video")->required();
    run->add_option("--seconds", options.seconds, "How long to play")
        ->check(CLI::Range(0.0, 86400.0))
        ->capture_default_str();
    run->add_option("--report", options.report, "JSON report to write");
    run->add_option("--pictures", options.pictures, "Directory for the views and slot images");
    run->add_option("--mishap", options.mishaps,
                    "DEVICE:KIND[:AFTER[:TIMES[:AMOUNT]]], to the emulated rig once the program is on show; repeatable")
        ->allow_extra_args(false);
    addRigChoice(*run, options.rig);
}

void addOptics(CLI::App& app, OpticsEvalOptions& eval, OpticsTableOptions& table, OpticsPlotOptions& plot) {
    auto* optics = app.add_subcommand(
        "optics", "The formulas: blur, borders and scale, over a file of cases, as tables or as charts");
    optics->require_subcommand(1);
    auto* cases =
        optics->add_subcommand("eval", "Every value of the cases in a CSV (w,P,e,r,Pe,De,Da,x1), with its status");
    cases->add_option("--path", eval.path, "precise, fast64 or fast32")
        ->check(CLI::IsMember({"precise", "fast64", "fast32"}))
        ->capture_default_str();
    cases->add_option("--in", eval.in, "CSV to read; hexadecimal or decimal floats")->required();
    cases->add_option("--out", eval.out, "CSV to write; hexadecimal floats")->required();
    auto* tables = optics->add_subcommand("table", "A table of the reference eye");
    tables->add_option("TABLE", table.table, "far-border, near-border, blur or scale")
        ->check(CLI::IsMember({"far-border", "near-border", "blur", "scale"}))
        ->required();
    auto* json = tables->add_flag("--json", table.json, "As JSON");
    tables->add_flag("--csv", table.csv, "As CSV")->excludes(json);
    auto* plots = optics->add_subcommand("plot", "A chart of the reference eye, like the paper's figures");
    plots->add_option("CHART", plot.chart, "far-border, near-border, blur or scale")
        ->check(CLI::IsMember({"far-border", "near-border", "blur", "scale"}))
        ->required();
    plots->add_option("-o,--out", plot.out, "PNG or SVG to write")->required();
}

struct LensOptions {
    LensRecordOptions record;
    LensChooseOptions choose;
    LensShapeOptions shape;
    std::string file, folder, out;
    bool json = false;
};

void addLens(CLI::App& app, LensOptions& options) {
    auto* lens =
        app.add_subcommand("lens", "Recorded lens waves: record (simulated), look into, import, choose, shape");
    lens->require_subcommand(1);
    const auto rate = [](CLI::App* command, double& rate_Hz) {
        command->add_option("--rate", rate_Hz, "Sweeps a second")
            ->check(CLI::Range(1.0, 1000.0))
            ->capture_default_str();
    };
    auto* record = lens->add_subcommand("record", "Records the lens emulator into a wave database");
    record->add_option("--preset", options.record.preset, "slow, datasheet, lively, clean or dirty")
        ->capture_default_str();
    rate(record, options.record.rate_Hz);
    auto* waves = record->add_option("--waves", options.record.waves, "How many, for a model")
                      ->check(CLI::Range(9, 10000))
                      ->capture_default_str();
    record->add_flag("--paper", options.record.paper, "The paper's 2485, between any two of 71 voltages")
        ->excludes(waves);
    record->add_option("--temperature", options.record.temperature_C, "Of the resting lens, in degrees C")
        ->check(CLI::Range(-20.0, 80.0))
        ->capture_default_str();
    record->add_option("--seed", options.record.seed, "Not 0: every parameter varied by up to 20 %");
    record->add_option("-o,--out", options.record.out, "Database to write (.ilflens)")->required();

    auto* info = lens->add_subcommand("info", "What a wave database holds");
    info->add_option("FILE", options.file, "Wave database")->required();
    info->add_flag("--json", options.json, "As JSON");
    auto* import = lens->add_subcommand("import", "CSV files of waves become a database");
    import->add_option("FOLDER", options.folder, "Folder of CSV files")->required();
    import->add_option("-o,--out", options.out, "Database to write (.ilflens)")->required();
    auto* exported = lens->add_subcommand("export", "A database's waves as CSV files");
    exported->add_option("FILE", options.file, "Wave database")->required();
    exported->add_option("-o,--out", options.folder, "New folder")->required();

    auto* choose = lens->add_subcommand("choose", "The wave that serves a sweep, or why there is none");
    choose->add_option("FILE", options.choose.file, "Wave database")->required();
    choose->add_option("--low", options.choose.low_D, "Lowest power in dioptres")->required();
    choose->add_option("--high", options.choose.high_D, "Highest power in dioptres")->required();
    choose->add_option("--mode", options.choose.mode, "paper, slot-aware, continuous or shaped")
        ->check(CLI::IsMember({"paper", "slot-aware", "continuous", "shaped"}))
        ->capture_default_str();
    rate(choose, options.choose.rate_Hz);
    choose->add_flag("--json", options.choose.json, "As JSON");

    auto* shape = lens->add_subcommand("shape", "Learns a wave on the lens emulator that holds the lens at its levels");
    auto* file = shape->add_option("FILE", options.shape.file, "Wave database of an emulated lens");
    shape->add_option("--preset", options.shape.preset, "An emulated lens instead of FILE")->excludes(file);
    shape->add_option("--levels", options.shape.levels_D, "In dioptres, such as 0,2.2")->delimiter(',')->required();
    shape->add_option("--duty", options.shape.duty, "Part of the sweep at each level")
        ->check(CLI::Range(0.001, 0.999))
        ->capture_default_str();
    shape->add_option("--harmonics", options.shape.harmonics, "Of the drive, at most")
        ->check(CLI::Range(1, 16))
        ->capture_default_str();
    rate(shape, options.shape.rate_Hz);
    shape->add_option("-o,--out", options.shape.out, "Database to write: FILE's waves and the learnt one");
    shape->add_flag("--json", options.shape.json, "As JSON");
}

int runLens(const CLI::App& lens, LensOptions& options) {
    if (lens.got_subcommand("record")) return lensRecordCommand(options.record);
    if (lens.got_subcommand("info")) return lensInfoCommand(options.file, options.json);
    if (lens.got_subcommand("import")) return lensImportCommand(options.folder, options.out);
    if (lens.got_subcommand("export")) return lensExportCommand(options.file, options.folder);
    if (lens.got_subcommand("choose")) return lensChooseCommand(options.choose);
    if (options.shape.file.empty() && options.shape.preset.empty()) options.shape.preset = "datasheet";
    return lensShapeCommand(options.shape);
}

void addEvaluate(CLI::App& app, EvaluateCommandOptions& options) {
    auto* evaluate = app.add_subcommand("evaluate", "The paper's evaluation on the simulated system, beside the paper");
    evaluate->add_option("-o,--out", options.folder, "Folder for report.md, report.json, charts and pictures");
    evaluate->add_flag("--quick", options.quick, "Fewer cases, in seconds");
}

void addSeams(CLI::App& app, SeamsOptions& options) {
    auto* seams =
        app.add_subcommand("seams", "How visible each border between sharp and blurred light is, for each eye");
    seams->add_option("FILE", options.file, "Project");
    seams
        ->add_option("--errors", options.errors,
                     "pupil=1,registration=0.25,gaze=5,lens=2 (mm), nearer=5,farther=10 (%)")
        ->delimiter(',');
    seams->add_option("--motion", options.motion_mm_s, "Speed of a moving region across the surface, mm/s")
        ->check(CLI::Range(0.1, 10000.0));
    seams->add_flag("--json", options.json, "As JSON");
    seams->add_option("--experiment", options.experiment,
                      "The paper's experiment on this folder's textures, without FILE");
    seams->add_option("-o,--out", options.out, "Folder for the experiment's pictures and seams.csv");
    addRigChoice(*seams, options.rig);
}

void addDecodeScan(CLI::App& app, DecodeScanOptions& options) {
    auto* decode = app.add_subcommand("decode-scan", "Saved pictures of a Gray-code scan become a map, checked");
    decode->footer(
        "DIR holds a camera's pictures (PNG, JPEG, TIFF, WebP) of one projector's patterns. Without a scan.json, in "
        "the\n"
        "order of their names: columns from the coarsest bit, each beside its inverse, rows likewise, white, black\n"
        "(OpenCV's order; 42 pictures for 1024x768). DIR/scan.json names other orders:\n"
        "  {\"format\": \"illuminatedfocus-scan\", \"version\": 1, \"projector\": [1024, 768],\n"
        "   \"pictures\": [{\"file\": \"a.png\", \"shows\": \"white\"}, {\"file\": \"b.png\", \"shows\": \"column 0 "
        "inverse\"}]}\n"
        "or \"order\": \"white-first\" or \"white-last\" instead of \"pictures\". Bit 0 is the coarsest. A scan that "
        "cannot be\n"
        "used names its cause: too-dark, saturated, moved, wrong-screen, other-order, ambient-light, previous-frame,\n"
        "glossy, flat (a note), few-pixels. Success is said after the map was written, read back and held against the\n"
        "scan's wide stripes. Exit codes: 0 done, 1 not usable or not written, 2 usage.");
    decode->add_option("DIR", options.folder, "Folder of the pictures")->required();
    decode->add_option("-o,--out", options.out, "Map to write: .yml, .yml.gz (OpenCV) or .exr")->required();
    decode->add_option("--projector", options.projector, "Its raster, such as 1024x768 (which is the default)");
    decode->add_option("--quality", options.quality, "PNG of what was decoded and why not");
    decode->add_flag("--json", options.json, "As JSON");
}

struct GltfOptions {
    std::string file;
    bool json = false;
    GltfDepthOptions depth;
};

void addGltf(CLI::App& app, GltfOptions& options) {
    auto* gltf =
        app.add_subcommand("gltf", "glTF scenes (.gltf, .glb): what is in them, and their depth as a camera sees it");
    gltf->require_subcommand(1);
    auto* info = gltf->add_subcommand("info", "Triangles, box, meshes, cameras, and what was repaired or ignored");
    info->footer("A file that is no sound glTF is refused with what is wrong and where (exit code 1).\n"
                 "JSON: triangles, vertices, bbox_min, bbox_max (metres; of decoded vertices), problems, meshes,\n"
                 "materials, cameras; of a refused file: refused, problems.");
    info->add_option("FILE", options.file, "Scene")->required();
    info->add_flag("--json", options.json, "As JSON");
    GltfDepthOptions& depth = options.depth;
    auto* draw = gltf->add_subcommand("depth", "Draws depth along a camera's axis, and a picture");
    draw->add_option("FILE", depth.file, "Scene")->required();
    draw->add_option("--camera", depth.camera, "One of the file's own, counted from 0")->check(CLI::NonNegativeNumber);
    draw->add_option("--pose", depth.pose, "X,Y,Z,TX,TY,TZ: where the camera is and a point it looks at, metres");
    draw->add_option("--pairs", depth.pairs,
                     "CSV of x,y,z,u,v: points of the scene (metres) and their pixels; four or more");
    draw->add_option("--focal", depth.focal_px, "In pixels; with --pose or --pairs, instead of --fov")
        ->check(CLI::PositiveNumber);
    draw->add_option("--fov", depth.fov_deg, "Degrees from top to bottom")
        ->check(CLI::Range(1.0, 170.0))
        ->capture_default_str();
    draw->add_option("--size", depth.size, "Of the picture")->capture_default_str();
    draw->add_option("--step", depth.step_mm, "Millimetres of a step of a 16-bit PNG")
        ->check(CLI::Range(0.001, 1000.0))
        ->capture_default_str();
    draw->add_option("-o,--out", depth.out, ".png (16 bits, 0: a hole), .pfm or .exr (metres)")->required();
    draw->add_option("--colour", depth.colour, "The same view as a picture (.png)");
}

void addDoctor(CLI::App& app, DoctorOptions& options) {
    auto* doctor = app.add_subcommand("doctor", "What is attached, whether it can be used, and what to do");
    doctor->footer(
        "Exit codes: 0 nothing wrong or nothing attached, 3 a device is there but cannot be used.\n"
        "Reads only. While an output core runs, devices are not asked how they are, unless with --ask.\n"
        "JSON: devices (kind, state, usable, name, where, node, usb, product, serial, firmware, mode,\n"
        "held_by, troubles, remarks), machine (id, standing, what, help, commands), output_core (running,\n"
        "processes), looked_for (usb, name, kind, driven), exit_code. States: ready, not-asked, in-our-use,\n"
        "no-permission, busy, silent, trouble, unsupported, gone. Standings: good, missing, unknown.");
    auto* json = doctor->add_flag("--json", options.json, "As JSON");
    auto* ask = doctor->add_flag("--ask", options.ask,
                                 "Asks devices even while an output core runs, except those it plays on: patterns that "
                                 "a projector shows are disturbed for a moment");
    doctor
        ->add_flag("--install-rules", options.installRules,
                   "Installs the udev rules (as root), or prints the commands that do")
        ->excludes(json)
        ->excludes(ask);
    doctor->add_option("--root", options.root, "Another system's files, for tests")->group("");
}

void addCalibrate(CLI::App& app, CalibrateOptions& options) {
    auto* calibrate =
        app.add_subcommand("calibrate", "Camera and projector from scans of a chessboard, one folder for each pose");
    calibrate->footer(
        "Each DIR holds one scan's pictures, as decode-scan reads them, with the board in another pose: five or more,\n"
        "tilted by 20 to 40 degrees to different sides. Metres come from the board's square. One pose, or nearly\n"
        "parallel ones, are refused. Exit codes: 0 done, 1 not usable or not written, 2 usage.");
    auto* folders = calibrate->add_option("DIR", options.folders, "Folders of the scans");
    calibrate->add_option("--board", options.board, "Its inner corners, where black squares meet")
        ->capture_default_str();
    calibrate->add_option("--square", options.square, "Side of a square on the print, with its unit")
        ->capture_default_str();
    calibrate->add_option("--projector", options.projector, "Its raster, such as 1024x768");
    calibrate
        ->add_option("--opencv", options.opencv, "Take over a calibration_result.xml of procam-calibration instead")
        ->excludes(folders);
    calibrate->add_option("-o,--out", options.out, "Calibration to write (.json)");
    calibrate->add_flag("--json", options.json, "As JSON: numbers, their deviations, residuals of each pose");
}

void addMeasure(CLI::App& app, MeasureDelayOptions& delay, MeasureRigOptions& rig) {
    auto* measure =
        app.add_subcommand("measure", "What a photodiode tells: a projector's delay, a lens's powers and waves");
    measure->require_subcommand(1);
    auto* delays = measure->add_subcommand("delay", "Of light after its trigger, from a recording of both");
    delays->add_option("RECORDING", delay.recording, ".csv (seconds, trigger, light), .wav or .flac")->required();
    delays->add_option("--frames", delay.frames_Hz, "Of the pattern a second, where there is no trigger")
        ->check(CLI::Range(0.0, 10000.0));
    delays->add_option("--shortest", delay.shortest_ms, "Milliseconds; edges nearer than this are one")
        ->check(CLI::Range(0.01, 1000.0))
        ->capture_default_str();
    delays->add_flag("--json", delay.json, "As JSON");
    auto* rigs = measure->add_subcommand("rig", "Step by step: the projector's delay, one lens at rest and in waves");
    rigs->add_option("--rig", rig.rig, "emulated, or a rig's file")->capture_default_str();
    rigs->add_option("--eye", rig.eye, "Whose lens is before the photodiode")
        ->check(CLI::IsMember({"left", "right"}))
        ->capture_default_str();
    rigs->add_option("--known", rig.known, "Powers that are known: lines of milliamperes, dioptres");
    rigs->add_option("--temperature", rig.temperature_C, "Of the lens, in degrees C")->check(CLI::Range(-20.0, 80.0));
    rigs->add_option("--rate", rig.rate_Hz, "Sweeps a second")->check(CLI::Range(10.0, 1000.0))->capture_default_str();
    rigs->add_option("--waves", rig.waves, "How many, for a model")->check(CLI::Range(9, 10000))->capture_default_str();
    rigs->add_option("--shape", rig.shape_D, "Learn a wave that holds these levels (dioptres) as well, such as 0,2.2")
        ->delimiter(',');
    rigs->add_option("--model", rig.model, "Of the lens");
    rigs->add_option("--serial", rig.serial, "Of the lens");
    rigs->add_flag("--no-projector", rig.withoutProjector, "Leave the projector's delay as it is");
    rigs->add_flag("--yes", rig.yes, "Everything is connected: ask nothing");
    rigs->add_flag("--replace", rig.replace, "Overwrite files that are there");
    rigs->add_option("-o,--out", rig.lens, "Wave database to write (.ilflens)")->required();
    rigs->add_option("--save-rig", rig.savedRig, "Rig to write (.json), with powers, delay and waves");
}

void addScan(CLI::App& app, ScanOptions& options) {
    auto* scan = app.add_subcommand("scan", "Where the camera's picture lands on the projector: shows patterns and "
                                            "takes pictures of them, on a core of its own");
    scan->footer(
        "Ends in steady white light. The map is written only when stripes shown anew confirm it. The camera\n"
        "\"emulated\" sees a desk in the light of simulated or emulated devices; after a colon it takes words:\n"
        "scene=FILE (glTF on the desk, or depth as seen by the camera: EXR, PNG, PFM; a name with commas in double\n"
        "quotes), scale=FACTOR, board=N, binning=N, roi=X:Y:W:H, ambient=LUX, delay=FRAMES, bump=MM, turn=DEGREES,\n"
        "hand, saturated, dark, wrong-screen, frozen, after=FRAMES, quiet, seed=N, with commas between them.");
    addRigChoice(*scan, options.rig);
    scan->add_option("--camera", options.camera, "Camera's id (see --list-devices), or emulated:WORDS");
    scan->add_option("-o,--out", options.out, "Map to write: .yml, .yml.gz or .exr")->required();
    scan->add_option("--keep", options.keep, "New folder for the pictures taken, for decode-scan");
    scan->add_option("--quality", options.quality, "PNG to write: what was decoded where, and why not");
    scan->add_option("--sweeps", options.sweeps, "Of exposure (0: as many as give good pictures)")
        ->check(CLI::Range(0, 60));
    scan->add_flag("--anyway", options.anyway, "Also where the room is too bright");
    scan->add_flag("--json", options.json, "As JSON");
}

void addTrack(CLI::App& app, TrackOptions& options) {
    auto* track =
        app.add_subcommand("track", "Where regions are that follow a marker or a flat thing, picture by picture");
    track->footer(
        "SOURCE is a folder of pictures, a video file, or emulated:marker=7,lap=4 (also cover=2:3.5, hand, binning=2,\n"
        "ambient=200, quiet, seed=N), whose truth is known: then errors are said, of what was seen and of where its\n"
        "light falls. Lines: state (following, holding, fading, lost), confidence, fade (0: its own look, 1: its safe\n"
        "one), the target's middle and the homography from where the region was painted. Exit codes: 0 done, 1 not "
        "usable.");
    track->add_option("SOURCE", options.source, "Pictures")->required();
    auto* project =
        track->add_option("--project", options.project, "Whose regions follow something, in its own picture");
    auto* marker = track->add_option("--marker", options.marker,
                                     "7 (AprilTag 36h11) or 6X6_250:7, as it lies in the first picture");
    auto* patch = track->add_option("--patch", options.patch, "X0,Y0,X1,Y1: a flat thing in the first picture");
    marker->excludes(project)->excludes(patch);
    patch->excludes(project);
    track->add_option("--when-lost", options.whenLost, "Its safe look")
        ->check(CLI::IsMember({"blur", "neutral", "focus"}))
        ->capture_default_str();
    track->add_option("--rate", options.rate_Hz, "Pictures a second, of a folder and the emulated scene")
        ->check(CLI::Range(1.0, 1000.0))
        ->capture_default_str();
    track->add_option("--seconds", options.seconds, "Of the emulated scene")
        ->check(CLI::Range(0.0, 600.0))
        ->capture_default_str();
    track->add_option("--ahead", options.ahead_ms, "Milliseconds from a picture's arrival to its light")
        ->check(CLI::Range(0.0, 100.0))
        ->capture_default_str();
    track->add_option("--hold", options.hold_ms, "Milliseconds it stays when lost")->check(CLI::Range(0.0, 60000.0));
    track->add_option("--fade", options.fade_ms, "Milliseconds it then fades")->check(CLI::Range(0.0, 60000.0));
    track->add_flag("--json", options.json, "As JSON");
}

void addStudio(CLI::App& app, StudioOptions& options) {
    app.add_option("FILE", options.file, "Project, picture or video to open");
    app.add_option("--scale", options.scale, "Size of the window's text and controls (0: the display's own)")
        ->check(CLI::Range(0.0, 4.0));
    app.add_option("--size", options.size, "Window size, such as 1600x1000");
    app.add_flag("--reset-layout", options.resetLayout, "Start with the default layout");
    app.add_option("--screenshot", options.screenshot, "Write a PNG of the window once its views are done, then quit");
    // For measurements (tests/bench/frame_times.sh), not for operators.
    app.add_option("--frame-times", options.frameTimes, "Write what each frame took as JSON when the window closes")
        ->group("");
    addRig(app, options.rig);
    app.add_option("--osc-port", options.oscPort,
                   "Hear poses by OSC on this UDP port, from this machine only: /pose/N x y [z rotation confidence]")
        ->check(CLI::Range(0, 65535));
    app.add_option(
        "--emulated-camera", options.emulatedCamera,
        "What the emulated camera sees: the words of scan's --camera emulated:WORDS, such as scene=FILE.glb");
    app.add_option("--view", options.view, "Tab to start with: scene, perceived, light or compare")
        ->check(CLI::IsMember({"scene", "perceived", "light", "compare"}));
}

}  // namespace

int main(int argc, char** argv) {
    readEmulatedScenes();
    CLI::App app("Paints focus and blur onto the real world: a studio for IlluminatedFocus.", "illuminatedfocus");
    app.footer(kFooter);
    app.set_version_flag("--version", std::string("illuminatedfocus ") + ilf::kVersion);
    app.require_subcommand(0, 1);
    bool listBindings = false;
    app.add_flag("--list-bindings", listBindings, "Every command with its keys");
    bool listDevices = false;
    app.add_flag("--list-devices", listDevices, "One line for each attached device: kind, state, name, where");

    StudioOptions studio;
    PlanOptions plan;
    RenderOptions render;
    RunOptions run;
    OpticsEvalOptions opticsEval;
    OpticsTableOptions opticsTable;
    OpticsPlotOptions opticsPlot;
    LensOptions lens;
    EvaluateCommandOptions evaluation;
    std::string validated;
    addStudio(app, studio);
    addPlan(app, plan);
    addRigChoice(addRender(app, render), render.rig);
    addRun(app, run);
    addOptics(app, opticsEval, opticsTable, opticsPlot);
    addEvaluate(app, evaluation);
    SeamsOptions seams;
    addSeams(app, seams);
    addLens(app, lens);
    MeasureDelayOptions measuredDelay;
    MeasureRigOptions measuredRig;
    addMeasure(app, measuredDelay, measuredRig);
    DecodeScanOptions decodedScan;
    addDecodeScan(app, decodedScan);
    CalibrateOptions calibration;
    addCalibrate(app, calibration);
    DoctorOptions doctor;
    addDoctor(app, doctor);
    GltfOptions gltf;
    addGltf(app, gltf);
    ScanOptions scan;
    addScan(app, scan);
    TrackOptions track;
    addTrack(app, track);
    RigChoice validatedRig;
    auto* validate =
        app.add_subcommand("validate", "Opens, plans and compiles a project and says what is wrong with it");
    validate->add_option("FILE", validated, "Project, picture or video")->required();
    addRigChoice(*validate, validatedRig);

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        const int code = app.exit(e);  // 0 for --help and --version
        return code == 0 ? kDone : kUsage;
    }
    try {
        if (listBindings) {
            std::cout << ilf::ui::bindingsText();
            return kDone;
        }
        if (listDevices) return listDevicesCommand();
        if (app.got_subcommand("decode-scan")) return decodeScanCommand(decodedScan);
        if (app.got_subcommand("doctor")) return doctorCommand(doctor);
        studio.coreProgram = run.coreProgram = scan.coreProgram = ilf::devices::coreExecutable().string();
        if (app.got_subcommand("plan")) return planCommand(plan);
        if (app.got_subcommand("render")) return renderCommand(render);
        if (app.got_subcommand("run")) return runCommand(run);
        if (app.got_subcommand("seams")) return seamsCommand(seams);
        if (app.got_subcommand("scan")) return scanCommand(scan);
        if (app.got_subcommand("track")) return trackCommand(track);
        if (app.got_subcommand("optics")) {
            const auto* optics = app.get_subcommand("optics");
            if (optics->got_subcommand("eval")) return opticsEvalCommand(opticsEval);
            return optics->got_subcommand("table") ? opticsTableCommand(opticsTable) : opticsPlotCommand(opticsPlot);
        }
        if (app.got_subcommand("lens")) return runLens(*app.get_subcommand("lens"), lens);
        if (app.got_subcommand("measure"))
            return app.get_subcommand("measure")->got_subcommand("rig") ? measureRigCommand(measuredRig)
                                                                        : measureDelayCommand(measuredDelay);
        if (app.got_subcommand("calibrate")) return calibrateCommand(calibration);
        if (app.got_subcommand("gltf"))
            return app.get_subcommand("gltf")->got_subcommand("info") ? gltfInfoCommand(gltf.file, gltf.json)
                                                                      : gltfDepthCommand(gltf.depth);
        if (app.got_subcommand("evaluate")) return evaluateCommand(evaluation);
        if (app.got_subcommand("validate")) return validateCommand(validated, validatedRig);
        if (const auto wished = wishedOfCamera(studio.emulatedCamera); !wished) {
            std::cerr << wished.error().what << '\n';
            return kFailed;
        }
        return runStudio(studio);
    } catch (const std::exception& e) {  // a library threw where nobody expected it
        std::cerr << "illuminatedfocus: stopped by an unexpected failure: " << e.what() << '\n';
        return kFailed;
    }
}
