#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "projects/gltf/checks.h"

namespace ilf::projects::gltf {

namespace {

using enum Checked::Need;
using nlohmann::json;

constexpr auto kMost = static_cast<std::int64_t>(kMaxBytes);

std::size_t sized(const std::optional<std::int64_t>& value) { return static_cast<std::size_t>(value.value_or(0)); }

/// A member of an object that was checked: its value, or 0.
std::size_t sizeAt(const json& object, const char* member) {
    const auto found = object.find(member);
    if (found == object.end()) return 0;
    return static_cast<std::size_t>(std::max<std::int64_t>(0, wholeOf(*found).value_or(0)));
}

void checkBuffer(const Checked& buffer) {
    buffer.whole("byteLength", 1, kMost, required);
    buffer.text("uri");
}

void checkMeshopt(const Checked& packed) {
    const auto buffer = packed.reference("buffer", "buffers", required);
    packed.whole("byteOffset", 0, kMost);
    const auto length = packed.whole("byteLength", 1, kMost, required);
    const auto stride = packed.whole("byteStride", 1, 256, required);
    packed.whole("count", 1, kMost, required);
    const auto mode = packed.text("mode", required);
    const auto filter = packed.text("filter");
    if (!buffer || !length || !stride || !mode) return;
    if (*mode == "ATTRIBUTES") {
        if (*stride % 4 != 0) packed.refuse("byteStride", "must be a multiple of 4");
    } else if (*mode == "TRIANGLES" || *mode == "INDICES") {
        if (*stride != 2 && *stride != 4) packed.refuse("byteStride", "must be 2 or 4");
        if (*mode == "TRIANGLES" && sizeAt(packed.json(), "count") % 3 != 0)
            packed.refuse("count", "must be a multiple of 3");
        if (filter && *filter != "NONE") packed.refuse("filter", "belongs to attributes only");
    } else {
        packed.refuse("mode", "is none that EXT_meshopt_compression knows");
    }
    if (filter && *filter != "NONE") {
        const bool fits = *filter == "OCTAHEDRAL"    ? *stride == 4 || *stride == 8
                          : *filter == "QUATERNION"  ? *stride == 8
                          : *filter == "EXPONENTIAL" ? *stride % 4 == 0
                                                     : false;
        if (!fits) packed.refuse("filter", "is none that can be read at this byteStride");
    }
}

void checkView(const Checked& view, const json& buffers) {
    const auto buffer = view.reference("buffer", "buffers", required);
    const auto offset = view.whole("byteOffset", 0, kMost);
    const auto length = view.whole("byteLength", 1, kMost, required);
    const auto stride = view.whole("byteStride", 4, 252);
    if (stride && *stride % 4 != 0) view.refuse("byteStride", "must be a multiple of 4");
    view.oneOf("target", {34962, 34963});
    const auto fits = [&](const Checked& part, std::size_t whose, std::size_t from, std::size_t many) {
        const std::size_t there = sizeAt(buffers[whose], "byteLength");
        if (from + many > there)
            part.refuse("reaches to byte " + std::to_string(from + many) + " of buffers[" + std::to_string(whose) +
                        "], which has " + std::to_string(there));
    };
    if (buffer && length) fits(view, *buffer, sized(offset), sized(length));
    if (!view.has("extensions")) return;
    const auto extensions = view.object("extensions");
    const auto packed = extensions ? extensions->object("EXT_meshopt_compression") : std::nullopt;
    if (!packed) return;
    checkMeshopt(*packed);
    const json& values = packed->json();
    if (const auto whose = packed->reference("buffer", "buffers"))
        fits(*packed, *whose, sizeAt(values, "byteOffset"), sizeAt(values, "byteLength"));
    if (sizeAt(values, "count") * sizeAt(values, "byteStride") != sized(length))
        packed->refuse("unpacks to " + std::to_string(sizeAt(values, "count") * sizeAt(values, "byteStride")) +
                       " bytes, where its buffer view has " + std::to_string(sized(length)));
}

/// Bytes of one element as it lies in the file: columns of small matrices begin at multiples of 4.
std::size_t bytesOfElement(const std::string& type, std::size_t component) {
    const std::size_t all = componentsOf(type) * component;
    if (type == "MAT2" && component == 1) return 8;
    if (type == "MAT3" && component < 4) return component == 1 ? 12 : 24;
    return all;
}

/// `count` elements from `offset` on must lie within the view, and each at a multiple of its component's size.
void checkReach(const Checked& part, const json& view, std::size_t offset, std::size_t count, std::size_t element,
                std::size_t component, bool strided) {
    const std::size_t stride = strided && view.contains("byteStride") ? sizeAt(view, "byteStride") : element;
    if (stride < element) {
        part.refuse("has elements of " + std::to_string(element) + " bytes, its buffer view strides " +
                    std::to_string(stride));
        return;
    }
    if (offset % component != 0) part.refuse("byteOffset", "is no multiple of its component's size");
    if ((sizeAt(view, "byteOffset") + offset) % component != 0)
        part.refuse("begins, with its buffer view, at no multiple of its component's size");
    const std::size_t end = offset + stride * (count - 1) + element, there = sizeAt(view, "byteLength");
    if (end > there)
        part.refuse("reaches to byte " + std::to_string(end) + " of its buffer view, which has " +
                    std::to_string(there));
}

void checkSparse(const Checked& sparse, std::size_t count, std::size_t element, std::size_t component,
                 const json& views) {
    const auto changed = sparse.whole("count", 1, static_cast<std::int64_t>(count), required);
    const auto indices = sparse.object("indices", required);
    const auto values = sparse.object("values", required);
    if (!indices || !values) return;
    const auto kind = indices->oneOf("componentType", {5121, 5123, 5125}, required);
    const auto where = indices->reference("bufferView", "bufferViews", required);
    const auto what = values->reference("bufferView", "bufferViews", required);
    const auto first = indices->whole("byteOffset", 0, kMost), second = values->whole("byteOffset", 0, kMost);
    if (!changed || !kind || !where || !what) return;
    const std::size_t bytes = bytesOfComponent(*kind);
    checkReach(*indices, views[*where], sized(first), sized(changed), bytes, bytes, false);
    checkReach(*values, views[*what], sized(second), sized(changed), element, component, false);
}

void checkAccessor(const Checked& accessor, const json& views) {
    const auto kind = accessor.oneOf("componentType", {5120, 5121, 5122, 5123, 5125, 5126}, required);
    const auto count = accessor.whole("count", 1, std::numeric_limits<std::int32_t>::max(), required);
    const auto type = accessor.text("type", required);
    const auto view = accessor.reference("bufferView", "bufferViews");
    const auto offset = accessor.whole("byteOffset", 0, kMost);
    if (offset && !accessor.has("bufferView")) accessor.refuse("byteOffset", "says nothing without a bufferView");
    if (accessor.flag("normalized").value_or(false) && kind && (*kind == 5126 || *kind == 5125))
        accessor.refuse("normalized", "can be true for bytes and shorts only");
    const std::size_t components = type ? componentsOf(*type) : 0;
    if (type && components == 0) accessor.refuse("type", "is none that can be read");
    if (!kind || !count || components == 0) return;
    accessor.numbers("min", components);
    accessor.numbers("max", components);
    const std::size_t component = bytesOfComponent(*kind), element = bytesOfElement(*type, component);
    if (view) checkReach(accessor, views[*view], sized(offset), sized(count), element, component, true);
    if (view && type->starts_with("MAT") && sized(offset) % 4 != 0)
        accessor.refuse("byteOffset", "of a matrix must be a multiple of 4");
    if (const auto sparse = accessor.object("sparse")) checkSparse(*sparse, sized(count), element, component, views);
}

}  // namespace

std::size_t bytesOfComponent(std::int64_t code) {
    switch (code) {
    case 5120:
    case 5121:
        return 1;
    case 5122:
    case 5123:
        return 2;
    case 5125:
    case 5126:
        return 4;
    default:
        return 0;
    }
}

std::size_t componentsOf(const std::string& type) {
    if (type == "SCALAR") return 1;
    if (type == "VEC2") return 2;
    if (type == "VEC3") return 3;
    if (type == "VEC4" || type == "MAT2") return 4;
    if (type == "MAT3") return 9;
    return type == "MAT4" ? 16 : 0;
}

void checkData(const Checked& gltf) {
    static const json kNone = json::array();
    const json& root = gltf.json();
    const json& buffers = root.contains("buffers") ? root["buffers"] : kNone;
    const json& views = root.contains("bufferViews") ? root["bufferViews"] : kNone;
    gltf.each("buffers", optional, [](const Checked& buffer, std::size_t) { checkBuffer(buffer); });
    gltf.each("bufferViews", optional, [&](const Checked& view, std::size_t) { checkView(view, buffers); });
    gltf.each("accessors", optional, [&](const Checked& one, std::size_t) { checkAccessor(one, views); });
}

}  // namespace ilf::projects::gltf
