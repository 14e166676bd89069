#include "app/headless/plan_command.h"

#include <cstdio>
#include <iostream>

#include "app/exit_code.h"
#include "app/open.h"
#include "app/words.h"
#include "core/document/edit.h"

namespace ilf::app {
namespace {

int refuse(const Error& error, int code) {
    std::cerr << "illuminatedfocus plan: " << error.what << '\n';
    return code;
}

/// "NAME,DISTANCE_M,LOOK": the name may hold commas, the last two parts are the distance and the look.
Result<PlanObject> parsedObject(const std::string& text) {
    const auto help = "\"" + text + "\" is no object: write NAME,DISTANCE_M,focus|blur|neutral, such as A,0.25,blur.";
    const auto last = text.rfind(',');
    if (last == std::string::npos || last == 0) return fail(Fault::outOfRange, help);
    const auto middle = text.rfind(',', last - 1);
    if (middle == std::string::npos || middle == 0) return fail(Fault::outOfRange, help);
    const auto look = lookFromWord(text.substr(last + 1));
    if (!look) return tl::unexpected(look.error());
    const auto metres = wholeNumber(std::string_view(text).substr(middle + 1, last - middle - 1));
    if (!metres) return fail(Fault::outOfRange, help);
    PlanObject object;
    object.name = text.substr(0, middle);
    const auto fits =
        checked(Distance(ConstantDistance{Metre::fromSi(*metres), {}}), "the distance of \"" + object.name + "\"");
    if (!fits) return tl::unexpected(fits.error());
    object.id = object.name;
    object.look = *look;
    object.nearest = object.farthest = Metre::fromSi(*metres);
    return object;
}

Result<std::vector<PlanObject>> parsedObjects(const std::vector<std::string>& texts) {
    std::vector<PlanObject> objects;
    for (const std::string& text : texts) {
        auto object = parsedObject(text);
        if (!object) return tl::unexpected(object.error());
        for (const PlanObject& other : objects) {
            if (other.id == object->id) {
                return fail(Fault::outOfRange, "Two objects are called \"" + object->name + "\": rename one.");
            }
        }
        objects.push_back(*std::move(object));
    }
    return objects;
}

/// The project, or an empty one that lends its wearer and rig to the objects.
Result<Document> documentOf(const PlanOptions& options) {
    Document document;
    if (!options.file.empty()) {
        auto opened = openAny(options.file);
        if (!opened) return tl::unexpected(opened.error());
        document = std::move(opened->document);
    } else {
        document.wearer.confusion.preset = CircleOfConfusion::Preset::oneArcmin;
    }
    if (!options.coc.empty()) {
        const auto confusion = confusionFromWord(options.coc);
        if (!confusion) return tl::unexpected(confusion.error());
        document.wearer.confusion = *confusion;
    }
    auto rig = withOptions(document.rig, options.rig);
    if (!rig) return tl::unexpected(rig.error());
    document.rig = *std::move(rig);
    if (options.alpha_D) return edited(std::move(document), SetAlpha{Dioptre::fromSi(*options.alpha_D)});
    return document;
}

Result<PlanInput> inputOf(const PlanOptions& options, const Document& document, LensPlanner& planner) {
    if (!options.file.empty()) return planner.input(document);
    auto objects = parsedObjects(options.objects);
    if (!objects) return tl::unexpected(objects.error());
    auto input = planner.input(document);
    if (input) input->objects = *std::move(objects);
    return input;
}

}  // namespace

int planCommand(const PlanOptions& options) {
    if (options.file.empty() == options.objects.empty()) {
        return refuse({Fault::outOfRange, "give either a FILE or objects: --object NAME,DISTANCE_M,focus|blur."},
                      kUsage);
    }
    const auto lens = simulatedLens(options.rig);
    if (!lens) return refuse(lens.error(), kUsage);
    LensPlanner planner(*lens);
    const auto refuseInput = [&](const Error& error) {
        const bool typed = options.file.empty() && error.fault == Fault::outOfRange;
        return refuse(error, typed ? kUsage : exitCode(error));
    };
    const auto document = documentOf(options);
    if (!document) return refuseInput(document.error());
    const auto input = inputOf(options, *document, planner);
    if (!input) return refuseInput(input.error());
    const auto planned = planner.plan(*input, nullptr, true);
    if (!planned) return refuse(planned.error(), exitCode(planned.error()));
    std::cout << (options.json ? planJson(*planned, *document) : planText(*planned, *document)) << std::endl;
    return kDone;
}

}  // namespace ilf::app
