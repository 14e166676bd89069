// Questions that need an answer first: files, recovery; and two sheets to read: shortcuts, about.
#include <ilf/version.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "ui/devices_card.h"
#include "ui/icons.h"
#include "ui/widgets.h"

namespace ilf::ui {

namespace {

namespace fs = std::filesystem;
using Purpose = FileDialog::Purpose;

bool saves(Purpose purpose) {
    return purpose == Purpose::saveAs || purpose == Purpose::exportView || purpose == Purpose::saveRig ||
           purpose == Purpose::storeWaves;
}

const char* titleOf(Purpose purpose) {
    switch (purpose) {
    case Purpose::open:
        return "Open a project, picture or video";
    case Purpose::openScene:
        return "Replace the scene";
    case Purpose::saveAs:
        return "Save the project";
    case Purpose::exportView:
        return "Export the view as PNG";
    case Purpose::openRig:
        return "Open a rig";
    case Purpose::saveRig:
        return "Save the rig";
    case Purpose::storeWaves:
        return "Store what was measured";
    case Purpose::intrinsics:
        return "Camera intrinsics for the depth map (JSON)";
    case Purpose::depthMap:
        break;
    }
    return "Load a depth map (16-bit PNG, PFM or EXR)";
}

/// A project folder is opened, not entered.
bool isProjectFolder(const std::string& name) { return name.size() > 5 && name.ends_with(".ilfd"); }

void readFolder(FileDialog& dialog) {
    dialog.entries.clear();
    dialog.problem.clear();
    std::error_code error;
    fs::directory_iterator files(dialog.folder, fs::directory_options::skip_permission_denied, error);
    if (error) {
        dialog.problem = "This folder can not be read: " + error.message() + ".";
        return;
    }
    for (const fs::directory_iterator end; files != end; files.increment(error)) {
        if (error) break;
        const std::string name = files->path().filename().string();
        if (name.empty() || name.front() == '.') continue;
        std::error_code ignored;
        const bool folder = files->is_directory(ignored);
        dialog.entries.push_back({name, folder, folder ? 0 : files->file_size(ignored)});
    }
    std::sort(dialog.entries.begin(), dialog.entries.end(), [](const auto& a, const auto& b) {
        const bool folderA = a.folder && !isProjectFolder(a.name), folderB = b.folder && !isProjectFolder(b.name);
        if (folderA != folderB) return folderA;
        return a.name < b.name;
    });
}

void enter(FileDialog& dialog, const fs::path& folder) {
    dialog.folder = folder.lexically_normal().string();
    dialog.confirmOverwrite = false;
    readFolder(dialog);
}

std::string sizeText(std::uintmax_t bytes) {
    if (bytes < 1024) return std::to_string(bytes) + " B";
    if (bytes < 1024 * 1024) return std::to_string(bytes / 1024) + " KB";
    return std::to_string(bytes / (1024 * 1024)) + " MB";
}

/// Answers the dialog; false when there is something to say first.
bool accept(Panel& p, FileDialog& dialog) {
    if (dialog.name.empty()) return false;
    fs::path path = fs::path(dialog.name).is_absolute() ? fs::path(dialog.name) : fs::path(dialog.folder) / dialog.name;
    std::error_code ignored;
    if (!saves(dialog.purpose) && fs::is_directory(path, ignored) && !isProjectFolder(path.filename().string())) {
        enter(dialog, path);
        dialog.name.clear();
        return false;
    }
    if (dialog.purpose == Purpose::saveAs && path.extension() != ".ilf" && path.extension() != ".ilfd") path += ".ilf";
    if (dialog.purpose == Purpose::exportView && path.extension() != ".png") path += ".png";
    if (dialog.purpose == Purpose::saveRig && path.extension() != ".json") path += ".json";
    if (dialog.purpose == Purpose::storeWaves && path.extension() != ".ilflens") path += ".ilflens";
    if (saves(dialog.purpose) && fs::exists(path, ignored) && !dialog.confirmOverwrite) {
        dialog.confirmOverwrite = true;
        return false;
    }
    if (!saves(dialog.purpose) && !fs::exists(path, ignored)) {
        dialog.problem = "There is no \"" + path.filename().string() + "\" in this folder.";
        return false;
    }
    switch (dialog.purpose) {
    case Purpose::open:
        p.requests.push_back(OpenFile{path.string(), false});
        break;
    case Purpose::openScene:
        p.requests.push_back(OpenFile{path.string(), true});
        break;
    case Purpose::saveAs:
        p.requests.push_back(SaveFile{path.string()});
        break;
    case Purpose::exportView:
        p.requests.push_back(ExportView{path.string()});
        break;
    case Purpose::openRig:
        wantRig(p, path.string());
        break;
    case Purpose::saveRig:
        p.requests.push_back(SaveRig{path.string()});
        break;
    case Purpose::storeWaves:
        p.requests.push_back(StoreMeasured{path.string()});
        break;
    case Purpose::depthMap:
        p.requests.push_back(LoadDepthMap{path.string(), {}, p.state.intrinsics});
        break;
    case Purpose::intrinsics:
        p.state.intrinsics = path.string();
        break;
    }
    return true;
}

/// A modal in the middle of the window; true while it is drawn, then End with ImGui::EndPopup().
bool beginSheet(Panel& p, const char* id, double width, double height, bool& open) {
    if (!ImGui::IsPopupOpen(id)) ImGui::OpenPopup(id);
    const double w = std::min(width * p.scale, p.at.top.w - 40 * p.scale);
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    const double h = std::min(height * p.scale, static_cast<double>(display.y) - 40 * p.scale);
    ImGui::SetNextWindowPos({display.x / 2, display.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
    ImGui::SetNextWindowSize(vec(w, h));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(p.px(20), p.px(16)));
    const bool drawn = ImGui::BeginPopupModal(
        id, nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
    ImGui::PopStyleVar();
    if (drawn && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape)) && !ImGui::IsAnyItemActive()) open = false;
    return drawn;
}

void fileDialog(Panel& p) {
    FileDialog& dialog = *p.state.fileDialog;
    bool open = true;
    if (!beginSheet(p, "###fileDialog", 760, 540, open)) return;
    text(titleOf(dialog.purpose), colour::text, Font::strong);
    const float side = ImGui::GetFrameHeight();
    if (iconButton("###parent", icon::levelUp, "..", false, side)) enter(dialog, fs::path(dialog.folder).parent_path());
    tooltip("The folder above.");
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    text(dialog.folder, colour::dim);

    const float footer = side * 2 + p.px(dialog.problem.empty() && !dialog.confirmOverwrite ? 24 : 52);
    const float listWidth = p.view.recent.empty() || saves(dialog.purpose) ? 0.0f : -p.px(210);
    ImGui::BeginChild("###files", {listWidth, -footer}, true, ImGuiWindowFlags_NoNavInputs);
    std::optional<fs::path> goTo;
    bool chosen = false;
    int index = 0;
    for (const auto& entry : dialog.entries) {
        ImGui::PushID(index++);
        const bool folder = entry.folder && !isProjectFolder(entry.name);
        const std::string sign =
            !hasIcons() ? (folder ? "/ " : "  ") : std::string(folder ? icon::folder : icon::file) + "  ";
        const bool on = dialog.name == entry.name;
        if (ImGui::Selectable((sign + entry.name + "###entry").c_str(), on,
                              ImGuiSelectableFlags_AllowDoubleClick | ImGuiSelectableFlags_DontClosePopups)) {
            dialog.problem.clear();
            dialog.confirmOverwrite = false;
            if (folder) {
                if (ImGui::IsMouseDoubleClicked(0) || on)
                    goTo = fs::path(dialog.folder) / entry.name;
                else
                    dialog.name = entry.name;
            } else {
                dialog.name = entry.name;
                chosen = ImGui::IsMouseDoubleClicked(0);
            }
        }
        if (!entry.folder) {
            ImGui::SameLine(ImGui::GetWindowWidth() - p.px(90));
            text(sizeText(entry.bytes), colour::dim, Font::small);
        }
        ImGui::PopID();
    }
    ImGui::EndChild();
    if (listWidth < 0) {
        ImGui::SameLine();
        ImGui::BeginChild("###recentFiles", {0, -footer}, true, ImGuiWindowFlags_NoNavInputs);
        heading("RECENT");
        for (std::size_t i = 0; i < p.view.recent.size(); ++i) {
            const RecentFile& recent = p.view.recent[i];
            if (ImGui::Selectable((recent.name + "###recent" + std::to_string(i)).c_str(), false,
                                  ImGuiSelectableFlags_DontClosePopups)) {
                dialog.name = recent.path;
            }
            tooltip(recent.path);
        }
        ImGui::EndChild();
    }
    if (goTo) {
        enter(dialog, *goTo);
        dialog.name.clear();
    }
    if (!dialog.problem.empty()) wrapped(dialog.problem, colour::fault, Font::small);
    if (dialog.confirmOverwrite)
        wrapped("A file of this name exists. Press Save again to replace it.", colour::warn, Font::small);
    ImGui::SetNextItemWidth(-p.px(220));
    const bool entered = ImGui::InputText("###fileName", &dialog.name, ImGuiInputTextFlags_EnterReturnsTrue);
    if (ImGui::IsItemEdited()) dialog.confirmOverwrite = false, dialog.problem.clear();
    ImGui::SameLine();
    const bool pressed = ImGui::Button(saves(dialog.purpose) ? "Save###accept" : "Open###accept", {p.px(100), 0});
    ImGui::SameLine();
    if (ImGui::Button("Cancel###cancel", {p.px(100), 0})) open = false;
    if ((entered || pressed || chosen) && accept(p, dialog)) open = false;
    if (!open) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
    if (!open) p.state.fileDialog.reset();
}

void recoveryDialog(Panel& p) {
    bool open = true;
    if (!beginSheet(p, "###recovery", 520, 190, open)) return;
    text("Work that was not saved", colour::text, Font::strong);
    wrapped(p.state.recovery->what + ". The studio ended before it was saved; it can be taken up where it was.");
    ImGui::Dummy({1, p.px(8)});
    std::optional<Recover::Choice> choice;
    if (ImGui::Button("Recover###recover", {p.px(130), p.px(36)})) choice = Recover::Choice::recover;
    if (p.state.recovery->savedFileExists) {
        ImGui::SameLine();
        if (ImGui::Button("Open what was saved###saved", {p.px(180), p.px(36)})) choice = Recover::Choice::openSaved;
    }
    ImGui::SameLine();
    if (ImGui::Button("Leave it###skip", {p.px(100), p.px(36)})) choice = Recover::Choice::skip;
    wrapped("Work that is left is not asked about again; it stays in the state folder for 30 days.", colour::dim,
            Font::small);
    if (choice) {
        p.requests.push_back(Recover{*choice});
        ImGui::CloseCurrentPopup();
    }
    ImGui::EndPopup();
    if (choice) p.state.recovery.reset();
}

void shortcutSheet(Panel& p) {
    bool open = true;
    if (!beginSheet(p, "###shortcutSheet", 900, 640, open)) return;
    text("Shortcuts", colour::text, Font::strong);
    ImGui::BeginChild("###keys", {0, -ImGui::GetFrameHeight() - p.px(10)}, false, ImGuiWindowFlags_NoNavInputs);
    if (ImGui::BeginTable("###table", 4, ImGuiTableFlags_SizingStretchProp)) {
        for (const CommandInfo& entry : commands()) {
            if (entry.key.key == 0) continue;
            ImGui::TableNextColumn();
            std::string keysText = keyText(entry.key);
            if (entry.otherKey.key != 0) keysText += ", " + keyText(entry.otherKey);
            text(keysText, colour::focus, Font::small);
            ImGui::TableNextColumn();
            text(entry.title, colour::text, Font::small);
        }
        const auto also = [](const char* keysText, const char* what) {
            ImGui::TableNextColumn();
            text(keysText, colour::focus, Font::small);
            ImGui::TableNextColumn();
            text(what, colour::text, Font::small);
        };
        also("Space-drag, middle drag", "Pan");
        also("Wheel", "Zoom about the cursor");
        also("Shift-click", "Straight line from the last point");
        also("D-drag", "Scrub the distance under the cursor");
        also("Alt with a shape", "Take away instead of adding");
        also("Right-click", "Remove a vertex");
        ImGui::EndTable();
    }
    ImGui::EndChild();
    if (ImGui::Button("Close###close", {p.px(100), 0})) open = false;
    if (!open) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
    if (!open) p.state.shortcutsOpen = false;
}

void aboutSheet(Panel& p) {
    bool open = true;
    if (!beginSheet(p, "###aboutSheet", 560, 270, open)) return;
    text(std::string("IlluminatedFocus Studio ") + kVersion, colour::text, Font::strong);
    wrapped("Focus and blur painted onto the real world: a tunable lens before the eye sweeps through powers while a "
            "high-speed projector lights each thing at the moment it shall be seen.");
    wrapped("After T. Ueda, D. Iwai, T. Hiraki, K. Sato, \"IlluminatedFocus: Vision Augmentation using Spatial "
            "Defocusing via Focal Sweep Eyeglasses and High-Speed Projector\", IEEE TVCG 26(5), 2020.",
            colour::dim);
    wrapped("Only wearers see the blur: without the lens the scene is evenly lit. MIT licence.", colour::dim);
    if (ImGui::Button("Close###close", {p.px(100), 0})) open = false;
    if (!open) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
    if (!open) p.state.aboutOpen = false;
}

}  // namespace

void openFileDialog(State& state, Purpose purpose, const View& view) {
    FileDialog dialog;
    dialog.purpose = purpose;
    std::error_code error;
    fs::path folder = view.fileName.empty() ? fs::current_path(error) : fs::path(view.fileName).parent_path();
    if (view.fileName.empty() && !view.recent.empty()) folder = fs::path(view.recent.front().path).parent_path();
    if (!fs::is_directory(folder, error)) folder = fs::current_path(error);
    if (purpose == Purpose::saveAs) {
        dialog.name =
            (view.fileName.empty() ? view.document.name + ".ilf" : fs::path(view.fileName).filename().string());
    }
    enter(dialog, folder);
    if (purpose == Purpose::exportView) dialog.name = view.document.name + ".png";
    if (purpose == Purpose::saveRig) dialog.name = view.document.rig.name + ".json";
    if (purpose == Purpose::storeWaves)
        dialog.name = state.measure.eye == Eye::left ? "lens-left.ilflens" : "lens-right.ilflens";
    state.fileDialog = std::move(dialog);
}

void dialogs(Panel& p) {
    State& state = p.state;
    // One at a time, the most pressing first.
    if (state.recovery)
        recoveryDialog(p);
    else if (state.fileDialog)
        fileDialog(p);
    else if (state.shortcutsOpen)
        shortcutSheet(p);
    else if (state.aboutOpen)
        aboutSheet(p);
    state.popupsOpen = state.recovery || state.fileDialog || state.shortcutsOpen || state.aboutOpen;
}

}  // namespace ilf::ui
