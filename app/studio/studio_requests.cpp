// What the studio does when a panel asks: one function for each request.
#include <algorithm>
#include <filesystem>

#include "app/pictures_of.h"
#include "app/studio/eye_view.h"
#include "app/studio/grabbed_rig.h"
#include "app/studio/studio.h"
#include "core/base/srgb.h"
#include "core/document/picture_change.h"
#include "projects/pictures.h"
#include "projects/wearer_rig.h"

namespace ilf::app {
namespace fs = std::filesystem;

void Studio::handle(const ui::Requests& requests) {
    for (const ui::Request& request : requests) {
        std::visit([this](const auto& asked) { on(asked); }, request);
    }
}

void Studio::on(const ui::EditRequest& request) {
    if (const auto done = editor_.handle(request); !done) say(done.error().what, ui::Tone::warning);
}

void Studio::on(const ui::CommitGesture& request) { editor_.commitGesture(request.label); }
void Studio::on(const ui::CancelGesture&) { editor_.cancelGesture(); }
void Studio::on(const ui::GoToHistory& request) { editor_.goTo(request.step); }

void Studio::edit(const Edit& edit) { on(ui::EditRequest{ui::EditRequest::When::commit, edit}); }

void Studio::on(const ui::RunCommand& request) {
    using ui::Command;
    switch (request.command) {
    case Command::newProject:
        show(blankProject());
        break;
    case Command::save:
        save(keeper_.projectPath());
        break;
    case Command::reopenLast:
        if (const auto last = keeper_.lastOther()) on(ui::OpenFile{*last, false});
        break;
    case Command::quit:
        closing_ = true;
        break;
    case Command::undo:
        editor_.undo();
        break;
    case Command::redo:
        editor_.redo();
        break;
    case Command::fullScreen:
        window_->toggleFullScreen();
        break;
    case Command::grab:
        grab();
        break;
    case Command::openCamera:
        on(ui::OpenCamera{});
        break;
    case Command::closeCamera:
        camera_.close();
        pictures_.hideLive();
        break;
    case Command::lockCamera:
        if (const auto locked = camera_.toggleLock(); !locked) say(locked.error().what, ui::Tone::warning);
        break;
    case Command::toggleLive:
        camera_.toggleLive();
        if (!camera_.live()) pictures_.hideLive();
        break;
    case Command::take:
        take();
        break;
    case Command::liveTake:
        liveTake_ = !liveTake_;
        if (liveTake_) take();
        break;
    case Command::safeLight:
        forgetTake();
        link_.safeLight();
        measurer_.stopStep();
        registrar_.cancel();
        break;
    case Command::acknowledgeFault:
        on(ui::AcknowledgeFault{});
        break;
    default:
        break;  // done by the ui itself
    }
}

void Studio::on(const ui::AcknowledgeFault&) { faultsSeen_ = core_.faults; }

void Studio::on(const ui::OpenFile& request) {
    if (request.asScene) {
        auto opened = openScene(request.path, keeper_.extras());
        if (!opened) return say(opened.error().what, ui::Tone::error);
        keeper_.setExtras(opened->extras);
        if (!opened->note.empty()) say(opened->note, ui::Tone::note);
        if (!opened->videoPath.empty()) camera_.openVideo(opened->videoPath);
        return setScene(std::move(opened->scene));
    }
    auto opened = openAny(request.path);
    if (!opened) return say(opened.error().what, ui::Tone::error);
    show(*std::move(opened));
}

void Studio::show(OpenedFile opened) {
    registrar_.close();
    camera_.close();
    pictures_.hideLive();
    forgetTake();
    const Document left = editor_.document();
    const bool unsaved = keeper_.unsaved(left);
    editor_.replace(opened.document);
    keeper_.opened(opened, editor_.history().revision(), unsaved ? &left : nullptr);
    takenRevision_ = editor_.history().revision();
    ui_.selected.clear();
    ui_.fitted = true;
    if (!opened.note.empty()) say(opened.note, ui::Tone::note);
    if (!opened.videoPath.empty()) camera_.openVideo(opened.videoPath);
    useChosenRig();
}

void Studio::useChosenRig() {
    const Rig& own = editor_.document().rig;
    const auto chosen = withOptions(own, options_.rig);
    if (!chosen) return say(chosen.error().what, ui::Tone::error);
    if (*chosen == own) return;
    edit(SetRig{*chosen});
    say("Planned for \"" + chosen->name + "\" instead of the project's rig; undo brings that back.", ui::Tone::note);
}

void Studio::on(const ui::UseRig& request) {
    if (measurer_.busy())
        return say("A rig is being measured: store or cancel that before choosing another.", ui::Tone::warning);
    if (registrar_.shows())
        return say("The projector shows patterns for the registration: cancel that before choosing another rig.",
                   ui::Tone::warning);
    registrar_.close();
    measurer_.cancel();  // a page that asks about the rig before this one
    RigChoice choice = options_.rig;
    choice.rig = request.rig;
    choice.bits.reset();
    const auto rig = withOptions(editor_.document().rig, choice);
    if (!rig) return say(rig.error().what, ui::Tone::error);
    auto arguments = coreArguments(choice);
    if (!arguments) return say(arguments.error().what, ui::Tone::error);
    options_.rig = std::move(choice);
    forgetTake();
    useChosenRig();
    link_.restartCore(*std::move(arguments));
}

void Studio::on(const ui::SaveRig& request) {
    const auto written = projects::writeRig(request.path, editor_.document().rig);
    say(written ? "Saved the rig as " + request.path + "." : written.error().what,
        written ? ui::Tone::note : ui::Tone::error);
}

void Studio::setScene(Scene scene) { edit(SetScene{carriedOver(editor_.document(), std::move(scene))}); }

void Studio::on(const ui::SaveFile& request) { save(request.path); }

void Studio::save(const std::string& path) {
    if (path.empty()) {  // untitled: the ui asks for a name first
        ui::Requests asked;
        ui::run(ui::Command::saveAs, view(), ui_, asked);
        return;
    }
    keeper_.save(path, editor_.document());
}

void Studio::on(const ui::ExportView& request) {
    const Document& document = editor_.document();
    Image<std::uint8_t> picture;
    if (ui_.mode == ui::ViewMode::scene) {
        picture = overlayPicture(document);
    } else if (ui_.mode == ui::ViewMode::light && done_.compiled) {
        picture = slotPicture(done_.compiled->program, ui_.slot);
    } else if (done_.compiled) {
        const Compiled& compiled = *done_.compiled;
        const ViewRequest wanted = askedOf(compiled, ui_.seeing, ui_.eye);
        const auto seen = perceived(compiled.document, compiled.plan, compiled.program, wanted);
        if (!seen) return say(seen.error().what, ui::Tone::error);
        picture = toSrgb8(*seen);
    } else {
        return say("There is no view to export yet: " +
                       (done_.refusal ? done_.refusal->what : "it is being worked out."),
                   ui::Tone::warning);
    }
    const auto written = projects::writePng(request.path, picture);
    say(written ? "Exported " + request.path + " (simulated)." : written.error().what,
        written ? ui::Tone::note : ui::Tone::error);
}

void Studio::on(const ui::OpenCamera& request) {
    if (registrar_.view()) return registrar_.chooseCamera(request.id);
    camera_.openLive(request.id);
}

void Studio::on(const ui::SeekVideo& request) { camera_.seek(request.position); }

void Studio::grab() {
    auto scene = camera_.grabbed();
    if (!scene) return say(scene.error().what, ui::Tone::warning);
    auto grab = grabbed(editor_.document(), *std::move(scene));
    if (!grab) return say(grab.error().what, ui::Tone::warning);
    const bool several = grab->edits.size() > 1;
    for (Edit& one : grab->edits) {
        if (const auto done = editor_.handle({ui::EditRequest::When::preview, std::move(one)}); !done) {
            editor_.cancelGesture();
            return say(done.error().what, ui::Tone::warning);
        }
    }
    editor_.commitGesture(several ? "Grab" : label(SetScene{}));
    if (!grab->note.empty()) say(grab->note, ui::Tone::note);
}

void Studio::on(const ui::Recover& request) {
    ui_.recovery.reset();
    auto opened = keeper_.answered(request.choice);
    if (!opened) return say(opened.error().what, ui::Tone::error);
    if (*opened) show(**std::move(opened));
}

}  // namespace ilf::app
