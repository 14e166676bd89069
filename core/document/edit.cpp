#include "core/document/edit.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/document/edit_parts.h"

namespace ilf {

namespace {

template <class... Cases>
struct Overloaded : Cases... {
    using Cases::operator()...;
};

std::string inQuotes(const Region& region) { return "\"" + region.name + "\""; }

tl::unexpected<Error> noSuchRegion(const RegionId& id) {
    return fail(Fault::notFound, "There is no region \"" + id + "\": it may have been deleted.");
}
tl::unexpected<Error> notTheBackground(const std::string& what) {
    return fail(Fault::outOfRange, "The background " + what + ".");
}
Result<void> unlocked(const Region& region) {
    if (!region.locked) return {};
    return fail(Fault::outOfRange, inQuotes(region) + " is locked: unlock it to change it.");
}

/// Where the region lies in the list, or nothing.
std::optional<std::size_t> indexOf(const Document& document, const RegionId& id) {
    const auto found = std::find_if(document.regions.begin(), document.regions.end(),
                                    [&](const Box<Region>& region) { return region->id == id; });
    if (found == document.regions.end()) return std::nullopt;
    return static_cast<std::size_t>(found - document.regions.begin());
}

/// The document with one region, or the background, changed by `change(Region&) -> Result<void>`. An edit that changes
/// nothing keeps the very box, so that nobody downstream has to look.
template <class Change>
Result<Document> withAnyRegion(Document document, const RegionId& id, const Change& change) {
    Box<Region>* box = nullptr;
    if (document.background && id == kBackgroundId) {
        box = &document.background;
    } else if (const auto index = indexOf(document, id)) {
        box = &document.regions[*index];
    } else {
        return noSuchRegion(id);
    }
    Region region = **box;
    if (Result<void> done = change(region); !done) return tl::unexpected(done.error());
    if (region != **box) *box = Box<Region>(std::move(region));
    return document;
}

template <class Change>
Result<Document> withUnlocked(Document document, const RegionId& id, const Change& change) {
    return withAnyRegion(std::move(document), id, [&](Region& region) -> Result<void> {
        if (auto ok = unlocked(region); !ok) return ok;
        return change(region);
    });
}

/// The document with the mask of an unlocked region replaced by `make(document, region) -> Result<Mask>`; its outline
/// dissolves into pixels.
template <class Make>
Result<Document> withMask(const Document& document, const RegionId& id, const Make& make) {
    if (id == kBackgroundId)
        return notTheBackground("fills what no region covers and cannot be painted: paint a region");
    return withUnlocked(document, id, [&](Region& region) -> Result<void> {
        Result<Mask> mask = make(region);
        if (!mask) return tl::unexpected(mask.error());
        if (*mask == region.mask) return {};
        region.mask = *std::move(mask);
        region.outline.reset();
        return {};
    });
}

Result<void> checkedStrength(const std::optional<Dioptre>& strength) {
    if (!strength) return {};
    if (isFinite(*strength) && *strength > 0.0_D && *strength <= 10.0_D) return {};
    return fail(Fault::outOfRange, "The strength of a blur must be more than 0 D and at most 10 D, not " +
                                       spokenNumber(strength->si()) + " D.");
}

/// A distance as it may lie on `region` of this document.
Result<void> checkedOn(const Document& document, const Region& region) {
    if (auto ok = checked(region.distance, "the distance of " + inQuotes(region)); !ok) return ok;
    if (std::holds_alternative<FromDepthMap>(region.distance) && !document.scene.depth) {
        return fail(Fault::notFound, "There is no depth map to read the distance of " + inQuotes(region) +
                                         " from: load one, or type the distance.");
    }
    if (auto surface = affineVergence(region); !surface) return tl::unexpected(surface.error());
    return {};
}

Result<void> freeId(const Document& document, const RegionId& id) {
    if (id.empty()) return fail(Fault::outOfRange, "A region needs an id.");
    if (findRegion(document, id) == nullptr && id != kBackgroundId) return {};
    return fail(Fault::outOfRange, "There already is a region \"" + id + "\": each needs an id of its own.");
}

Result<void> fitting(const Document& document, const Mask& mask) {
    const Size picture = document.scene.size();
    if (mask.size() == picture) return {};
    const auto spoken = [](Size s) { return std::to_string(s.width) + " x " + std::to_string(s.height); };
    return fail(Fault::outOfRange, "The mask has " + spoken(mask.size()) + " pixels and the picture " +
                                       spoken(picture) + ": they must agree.");
}

Result<Document> added(Document document, const AddRegion& e) {
    Region region = e.region;
    if (auto ok = freeId(document, region.id); !ok) return tl::unexpected(ok.error());
    Result<std::string> name = checkedName(region.name);
    if (!name) return tl::unexpected(name.error());
    region.name = *name;
    if (region.mask.empty()) region.mask = Mask(document.scene.size());
    if (auto ok = fitting(document, region.mask); !ok) return tl::unexpected(ok.error());
    if (auto ok = checkedStrength(region.strength); !ok) return tl::unexpected(ok.error());
    if (auto ok = checkedOn(document, region); !ok) return tl::unexpected(ok.error());
    if (region.outline) {
        if (auto ok = checked(*region.outline); !ok) return tl::unexpected(ok.error());
    }
    const auto count = static_cast<int>(document.regions.size());
    document.regions.insert(document.regions.begin() + std::clamp(e.index, 0, count), Box<Region>(std::move(region)));
    return document;
}

Result<Document> removed(Document document, const RemoveRegion& e) {
    if (e.region == kBackgroundId) return notTheBackground("cannot be deleted: give it another look instead");
    const auto index = indexOf(document, e.region);
    if (!index) return noSuchRegion(e.region);
    if (auto ok = unlocked(*document.regions[*index]); !ok) return tl::unexpected(ok.error());
    document.regions.erase(document.regions.begin() + static_cast<std::ptrdiff_t>(*index));
    return document;
}

Result<Document> duplicated(Document document, const DuplicateRegion& e) {
    if (e.region == kBackgroundId) return notTheBackground("exists once and cannot be duplicated");
    const auto index = indexOf(document, e.region);
    if (!index) return noSuchRegion(e.region);
    if (auto ok = freeId(document, e.copy); !ok) return tl::unexpected(ok.error());
    Region copy = *document.regions[*index];
    copy.id = e.copy;
    if (Result<std::string> name = checkedName(copy.name + " copy")) copy.name = *name;
    copy.locked = false;
    document.regions.insert(document.regions.begin() + static_cast<std::ptrdiff_t>(*index),
                            Box<Region>(std::move(copy)));
    return document;
}

Result<Document> moved(Document document, const MoveRegion& e) {
    if (e.region == kBackgroundId) return notTheBackground("lies under all regions and cannot be moved");
    const auto index = indexOf(document, e.region);
    if (!index) return noSuchRegion(e.region);
    Box<Region> region = document.regions[*index];
    document.regions.erase(document.regions.begin() + static_cast<std::ptrdiff_t>(*index));
    const auto count = static_cast<int>(document.regions.size());
    document.regions.insert(document.regions.begin() + std::clamp(e.index, 0, count), std::move(region));
    return document;
}

/// Sets one of the switches of a region; the background has none.
Result<Document> switched(Document document, const RegionId& id, bool Region::* which, bool on) {
    if (id == kBackgroundId) return notTheBackground("is always there: it cannot be hidden, locked or soloed");
    return withAnyRegion(std::move(document), id, [&](Region& region) -> Result<void> {
        region.*which = on;
        return {};
    });
}

}  // namespace

Result<Document> edited(Document document, const Edit& edit) {
    const auto cases = Overloaded{
        [&](const AddRegion& e) -> Result<Document> { return added(std::move(document), e); },
        [&](const RemoveRegion& e) -> Result<Document> { return removed(std::move(document), e); },
        [&](const DuplicateRegion& e) -> Result<Document> { return duplicated(std::move(document), e); },
        [&](const MoveRegion& e) -> Result<Document> { return moved(std::move(document), e); },
        [&](const RenameRegion& e) -> Result<Document> {
            if (e.region == kBackgroundId) return notTheBackground("keeps its name");
            const Result<std::string> name = checkedName(e.name);
            if (!name) return tl::unexpected(name.error());
            return withUnlocked(std::move(document), e.region, [&](Region& region) -> Result<void> {
                region.name = *name;
                return {};
            });
        },
        [&](const SetLook& e) -> Result<Document> {
            return withUnlocked(std::move(document), e.region, [&](Region& region) -> Result<void> {
                region.look = e.look;
                return {};
            });
        },
        [&](const SetStrength& e) -> Result<Document> {
            if (auto ok = checkedStrength(e.strength); !ok) return tl::unexpected(ok.error());
            return withUnlocked(std::move(document), e.region, [&](Region& region) -> Result<void> {
                region.strength = e.strength;
                return {};
            });
        },
        [&](const SetDistance& e) -> Result<Document> {
            const Document& before = document;
            return withUnlocked(document, e.region, [&](Region& region) -> Result<void> {
                region.distance = e.distance;
                return checkedOn(before, region);
            });
        },
        [&](const SetVisible& e) { return switched(std::move(document), e.region, &Region::visible, e.on); },
        [&](const SetLocked& e) { return switched(std::move(document), e.region, &Region::locked, e.on); },
        [&](const SetSolo& e) { return switched(std::move(document), e.region, &Region::solo, e.on); },
        [&](const Paint& e) -> Result<Document> {
            return withMask(document, e.region, [&](const Region& r) { return withPaint(document, r, e); });
        },
        [&](const FillShape& e) -> Result<Document> {
            return withMask(document, e.region, [&](const Region& r) { return withShape(document, r, e); });
        },
        [&](const SetOutline& e) -> Result<Document> {
            if (e.region == kBackgroundId) return notTheBackground("fills what no region covers and has no outline");
            if (auto ok = checked(e.outline); !ok) return tl::unexpected(ok.error());
            const Size size = document.scene.size();
            return withUnlocked(std::move(document), e.region, [&](Region& region) -> Result<void> {
                region.mask = rasterised(e.outline, size);
                region.outline = e.outline;
                return {};
            });
        },
        [&](const SetMask& e) -> Result<Document> {
            if (auto ok = fitting(document, e.mask); !ok) return tl::unexpected(ok.error());
            return withMask(document, e.region, [&](const Region&) -> Result<Mask> { return e.mask; });
        },
        [&](const GrowMask& e) -> Result<Document> {
            if (auto ok = inRange("the way to grow", e.radius, -1000.0, 1000.0, "px"); !ok) {
                return tl::unexpected(ok.error());
            }
            return withMask(document, e.region,
                            [&](const Region& r) -> Result<Mask> { return grown(r.mask, e.radius); });
        },
        [&](const InvertMask& e) -> Result<Document> {
            return withMask(document, e.region, [&](const Region& r) -> Result<Mask> { return inverted(r.mask); });
        },
        [&](const SetSeam& e) -> Result<Document> {
            if (auto ok = inRange("the feather", e.seam.feather.in(1.0_mm), 0.0, 200.0, "mm"); !ok) {
                return tl::unexpected(ok.error());
            }
            document.seam = e.seam;
            return std::move(document);
        },
        [&](const SetAlpha& e) -> Result<Document> {
            if (auto ok = inRange("alpha", e.alpha.si(), 0.0, 5.0, "D"); !ok) return tl::unexpected(ok.error());
            document.alpha = e.alpha;
            return std::move(document);
        },
        [&](const SetMeasuredDepth& e) { return withMeasured(std::move(document), e); },
        [&](const SetViewerPose& e) { return withViewer(std::move(document), e); },
        [&](const SetDepthScale& e) { return withDepthScale(std::move(document), e); },
        [&](const SetPixelScale& e) { return withPixelScale(std::move(document), e); },
        [&](const SetFollow& e) -> Result<Document> {
            if (e.region == kBackgroundId) return notTheBackground("stays where it is and follows nothing");
            if (e.follow) {
                if (auto ok = checked(*e.follow, document.scene.size()); !ok) return tl::unexpected(ok.error());
            }
            return withUnlocked(std::move(document), e.region, [&](Region& region) -> Result<void> {
                region.follow = e.follow;
                return {};
            });
        },
        [&](const SetScene& e) -> Result<Document> { return withScene(std::move(document), e.scene); },
        [&](const SetWearer& e) -> Result<Document> {
            if (auto ok = checked(e.wearer); !ok) return tl::unexpected(ok.error());
            if (auto ok = checkedTogether(e.wearer, document.rig); !ok) return tl::unexpected(ok.error());
            const bool moved = document.wearer.lensToPupil != e.wearer.lensToPupil;
            document.wearer = e.wearer;
            return moved ? withDistancesAnew(std::move(document)) : std::move(document);
        },
        [&](const SetRig& e) -> Result<Document> {
            if (auto ok = checked(e.rig); !ok) return tl::unexpected(ok.error());
            if (auto ok = checkedTogether(document.wearer, e.rig); !ok) return tl::unexpected(ok.error());
            document.rig = e.rig;
            return std::move(document);
        },
        [&](const SetName& e) -> Result<Document> {
            const Result<std::string> name = checkedName(e.name);
            if (!name) return tl::unexpected(name.error());
            document.name = *name;
            return std::move(document);
        },
    };
    return std::visit(cases, edit);
}

std::string label(const Edit& edit) {
    const auto words = Overloaded{
        [](const AddRegion&) { return std::string("Add region"); },
        [](const RemoveRegion&) { return std::string("Delete region"); },
        [](const DuplicateRegion&) { return std::string("Duplicate region"); },
        [](const RenameRegion&) { return std::string("Rename"); },
        [](const MoveRegion&) { return std::string("Reorder"); },
        [](const SetLook&) { return std::string("Set look"); },
        [](const SetStrength&) { return std::string("Set strength"); },
        [](const SetDistance&) { return std::string("Set distance"); },
        [](const SetVisible& e) { return std::string(e.on ? "Show" : "Hide"); },
        [](const SetLocked& e) { return std::string(e.on ? "Lock" : "Unlock"); },
        [](const SetSolo& e) { return std::string(e.on ? "Solo" : "End solo"); },
        [](const Paint& e) { return std::string(e.mode == PaintMode::add ? "Paint" : "Erase"); },
        [](const FillShape& e) { return std::string(e.mode == PaintMode::add ? "Fill shape" : "Cut shape"); },
        [](const SetOutline&) { return std::string("Edit outline"); },
        [](const SetMask& e) { return e.how.empty() ? std::string("Set mask") : e.how; },
        [](const GrowMask& e) { return std::string(e.radius < 0.0 ? "Shrink" : "Grow"); },
        [](const InvertMask&) { return std::string("Invert"); },
        [](const SetSeam&) { return std::string("Set seam"); },
        [](const SetAlpha&) { return std::string("Set alpha"); },
        [](const SetMeasuredDepth& e) { return std::string(e.measured ? "Set depth map" : "Remove depth map"); },
        [](const SetViewerPose&) { return std::string("Move the wearer"); },
        [](const SetFollow& e) { return std::string(e.follow ? "Set what it follows" : "Follow nothing"); },
        [](const SetDepthScale&) { return std::string("Set depth scale"); },
        [](const SetPixelScale&) { return std::string("Set field of view"); },
        [](const SetScene&) { return std::string("Change picture"); },
        [](const SetWearer&) { return std::string("Set wearer"); },
        [](const SetRig&) { return std::string("Set rig"); },
        [](const SetName&) { return std::string("Rename project"); },
    };
    return std::visit(words, edit);
}

}  // namespace ilf
