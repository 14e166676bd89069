#include "devices/link/program_update.h"

#include <algorithm>

#include "devices/link/codec.h"

namespace ilf::devices {
namespace {

std::string name(std::uint64_t hash) {
    static constexpr char kDigits[] = "0123456789abcdef";
    std::string out(16, '0');
    for (std::size_t i = 0; i < 16; ++i)
        out[15 - i] = kDigits[(hash >> (4 * i)) & 15U];
    return out;
}

/// Where two tiles differ; they do somewhere.
TilePart partThatDiffers(const Tile& one, const Tile& other) {
    int x0 = kTile, y0 = kTile, x1 = 0, y1 = 0;
    for (int y = 0; y < kTile; ++y) {
        const auto* a = one.v.data() + y * kTile;
        const auto* b = other.v.data() + y * kTile;
        const auto first = static_cast<int>(std::mismatch(a, a + kTile, b).first - a);
        if (first == kTile) continue;
        int last = kTile - 1;
        while (a[last] == b[last])
            --last;
        x0 = std::min(x0, first);
        x1 = std::max(x1, last + 1);
        y0 = std::min(y0, y);
        y1 = y + 1;
    }
    return {x0, y0, x1 - x0, y1 - y0};
}

/// `from` within `part`, `beside` elsewhere.
Tile pasted(const Tile& from, const TilePart& part, const Tile& beside) {
    Tile tile = beside;
    for (int y = part.y; y < part.y + part.height; ++y)
        std::copy_n(from.v.data() + y * kTile + part.x, part.width, tile.v.data() + y * kTile + part.x);
    return tile;
}

}  // namespace

ProgramUpdate difference(const Program& program, std::uint64_t hash, const Program* base, std::uint64_t baseHash) {
    ProgramUpdate update;
    update.hash = hash;
    if (base != nullptr) update.base = baseHash;
    update.waveform = program.waveform;
    update.slotRate = program.slotRate;
    update.projectorDelay = program.projectorDelay;
    update.projector = program.projector;
    update.images = static_cast<int>(program.images.size());
    update.imageOfSlot = program.imageOfSlot;
    for (std::size_t i = 0; i < program.images.size(); ++i) {
        const LightImage& image = program.images[i];
        const bool hasBase = base != nullptr && i < base->images.size() && base->images[i].size() == image.size();
        for (int row = 0; row < image.rows(); ++row) {
            for (int column = 0; column < image.columns(); ++column) {
                const Box<Tile>& tile = image.tile(column, row);
                const Box<Tile>& before = hasBase ? base->images[i].tile(column, row) : uniformTile(0);
                if (tile == before) continue;
                TileUpdate changed{static_cast<int>(i), column, row, tile, {}};
                // An even tile is a single byte already; one without a base has nothing to lie beside.
                if (hasBase && !tile.same(uniformTile(tile->v[0]))) {
                    changed.part = partThatDiffers(*tile, *before);
                    if (!changed.part.isWhole()) changed.tile = boxed(pasted(*tile, changed.part, Tile{}));
                }
                update.tiles.push_back(std::move(changed));
            }
        }
    }
    return update;
}

bool needsAnotherBase(const ProgramUpdate& update, const Program* base, std::uint64_t baseHash) {
    return update.base && (base == nullptr || baseHash != *update.base);
}

Result<Program> assembled(const ProgramUpdate& update, const Program* base, std::uint64_t baseHash) {
    if (needsAnotherBase(update, base, baseHash))
        return fail(Fault::badFile, "An update differs from program " + name(*update.base) +
                                        ", which is not the one held here; the whole program must be sent.");
    const Size size = update.projector;
    if (size.width < 1 || size.height < 1 || size.width > kMaxSide || size.height > kMaxSide)
        return fail(Fault::badFile, "An update is for a projector of " + std::to_string(size.width) + " x " +
                                        std::to_string(size.height) + " pixels, which no projector has.");
    const auto tilesOf = [](int pixels) { return (pixels + kTile - 1) / kTile; };
    if (update.images < 0 || update.images > kMaxImages ||
        update.images * tilesOf(size.width) * tilesOf(size.height) > kMaxTiles)
        return fail(Fault::badFile,
                    "An update announces " + std::to_string(update.images) + " images, more than any program has.");
    for (const int image : update.imageOfSlot)
        if (image != Program::kDark && (image < 0 || image >= update.images))
            return fail(Fault::badFile, "An update lights a slot with image " + std::to_string(image) + " of " +
                                            std::to_string(update.images) + ".");
    Program program;
    program.waveform = update.waveform;
    program.slotRate = update.slotRate;
    program.projectorDelay = update.projectorDelay;
    program.projector = size;
    program.imageOfSlot = update.imageOfSlot;
    for (std::size_t i = 0; i < static_cast<std::size_t>(update.images); ++i) {
        const bool hasBase = update.base && i < base->images.size() && base->images[i].size() == size;
        program.images.push_back(hasBase ? base->images[i] : LightImage(size));
    }
    for (const auto& t : update.tiles) {
        if (t.image < 0 || t.image >= update.images || t.column < 0 || t.row < 0 || t.column >= tilesOf(size.width) ||
            t.row >= tilesOf(size.height) || !t.tile)
            return fail(Fault::badFile, "An update holds a tile that lies outside its program.");
        LightImage& image = program.images[static_cast<std::size_t>(t.image)];
        if (t.part.isWhole())
            image.setTile(t.column, t.row, t.tile);
        else
            image.setTile(t.column, t.row, boxed(pasted(*t.tile, t.part, *image.tile(t.column, t.row))));
    }
    const std::uint64_t hash = contentHash(program);
    if (hash != update.hash)
        return fail(Fault::badFile, "A program arrived as " + name(hash) + " but was announced as " +
                                        name(update.hash) + "; the whole program must be sent.");
    return program;
}

}  // namespace ilf::devices
