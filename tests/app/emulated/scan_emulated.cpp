// `scan --rig emulated`: in real time, so it runs with nothing beside it.
#include <doctest/doctest.h>

#include "tests/app/emulated/rig_there.h"
#include "tests/app/emulated/scanned.h"

using namespace ilf;

TEST_CASE("scan --rig emulated: the same through unmodified drivers and emulated cables") {
    if (!rigThere()) return;
    const TemporaryDirectory folder;
    Ran ran;
    for (int tries = 0; tries < 3; ++tries) {  // it keeps real time, which a busy machine may not
        ran = scanned(folder, "--rig emulated --camera emulated:binning=2 --json");
        if (ran.code == 0) break;
        MESSAGE("tried again: ", ran.out);
    }
    checkMap(folder, ran);
}
