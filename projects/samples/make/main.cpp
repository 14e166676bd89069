// make-samples: draws the sample scenes and saves them as projects.
#include <chrono>
#include <filesystem>
#include <iostream>
#include <string_view>

#include "project.h"
#include "projects/project_file.h"
#include "scanned.h"
#include "scenes.h"

namespace {

using namespace ilf;

/// Rays along each side of a pixel that is not smooth: nine where there is an edge or type.
constexpr int kSamplesAcross = 3;

int usage() {
    std::cerr << "usage: make-samples FOLDER [NAME...]\n"
                 "Draws the sample projects (all, or the named ones) and saves them in FOLDER.\n"
                 "Names: museum-guide, study-desk, tutorial-recording, four-objects, scanned-desk\n";
    return 2;
}

}  // namespace

int main(int count, char** words) {
    if (count < 2 || std::string_view(words[1]).starts_with("-")) return usage();
    const std::filesystem::path folder = words[1];
    bool drewAny = false;
    for (const auto make : {samples::museumGuide, samples::studyDesk, samples::tutorialRecording, samples::fourObjects,
                            samples::scannedDesk}) {
        const samples::Scene scene = make();
        if (count > 2 && std::find(words + 2, words + count, scene.name) == words + count) continue;
        drewAny = true;
        const auto began = std::chrono::steady_clock::now();
        const samples::Rendering rendering = samples::rendered(scene, kSamplesAcross);
        Result<Document> document = samples::project(scene, rendering);
        if (make == samples::scannedDesk) document = samples::scanned(*std::move(document), scene, rendering);
        if (!document) {
            std::cerr << document.error().what << '\n';
            return 1;
        }
        const auto place = folder / (scene.name + ".ilfd");
        if (const auto saved = projects::saveProject(place, *document, {}, projects::Backups::none); !saved) {
            std::cerr << saved.error().what << '\n';
            return 1;
        }
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
        std::cout << place.string() << ": " << took.count() << " s\n";
    }
    return drewAny ? 0 : usage();
}
