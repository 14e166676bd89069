#include "devices/link/program_update.h"

#include "tests/devices/programs.h"
#include "tests/support/law.h"

namespace ilf::devices {

TEST_CASE("update: the difference, put onto its base, is the whole program") {
    law("assembled(difference(program, base), base) == program", [] {
        const auto base = test::program(*rc::gen::inRange(0U, 100U));
        auto next = *rc::gen::arbitrary<bool>() ? test::dabbed(base, *rc::gen::arbitrary<std::uint8_t>())
                                                : test::program(*rc::gen::inRange(0U, 100U));
        const auto images = *rc::gen::inRange<std::size_t>(1, 4);
        next.images.resize(images, test::picture(next.projector, 9));
        for (int& image : next.imageOfSlot)
            if (image >= static_cast<int>(images)) image = 0;
        const auto update = difference(next, contentHash(next), &base, contentHash(base));
        const auto back = assembled(update, &base, contentHash(base));
        RC_ASSERT(back.has_value());
        RC_ASSERT(*back == next);
        RC_ASSERT(*assembled(difference(next, contentHash(next))) == next);
    });
}

TEST_CASE("update: a dab sends the tile it changed and no other") {
    const auto base = test::program(4);
    const auto next = test::dabbed(base, 77);
    CHECK(difference(next, contentHash(next), &base, contentHash(base)).tiles.size() == 1);
    CHECK(difference(base, contentHash(base), &base, contentHash(base)).tiles.empty());
}

TEST_CASE("update: a base of another projector is not used") {
    const auto base = test::program(4);
    const auto next = test::program(4, 2.27_D, {300, 64});
    const auto update = difference(next, contentHash(next), &base, contentHash(base));
    CHECK(*assembled(update, &base, contentHash(base)) == next);
}

TEST_CASE("update: what does not fit together is refused") {
    const auto base = test::program(4);
    const auto next = test::dabbed(base, 77);
    const auto good = difference(next, contentHash(next), &base, contentHash(base));

    CHECK(needsAnotherBase(good, nullptr, 0));
    CHECK(assembled(good).error().what.ends_with("the whole program must be sent."));
    CHECK(assembled(good, &next, contentHash(next)).error().fault == Fault::badFile);

    auto wrongHash = good;
    wrongHash.hash ^= 1;
    CHECK(assembled(wrongHash, &base, contentHash(base)).error().what.find("was announced as") != std::string::npos);

    auto outside = good;
    outside.tiles[0].column = 99;
    CHECK(assembled(outside, &base, contentHash(base)).error().what ==
          "An update holds a tile that lies outside its program.");
    auto noImage = good;
    noImage.tiles[0].image = 2;
    CHECK_FALSE(assembled(noImage, &base, contentHash(base)).has_value());
    auto slot = good;
    slot.imageOfSlot[3] = 2;
    CHECK(assembled(slot, &base, contentHash(base)).error().what == "An update lights a slot with image 2 of 2.");
    auto size = good;
    size.projector = {0, 100};
    CHECK_FALSE(assembled(size, &base, contentHash(base)).has_value());
    auto many = difference(next, contentHash(next));
    many.images = 100000;
    CHECK_FALSE(assembled(many).has_value());
}

}  // namespace ilf::devices
