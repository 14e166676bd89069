// The one table of commands: complete, unique, reachable.
#include <doctest/doctest.h>

#include <set>
#include <string>

#include "ui/commands.h"
#include "ui/keys.h"

using namespace ilf::ui;

TEST_CASE("commands: every command is in the table once, under a name of its own") {
    std::set<std::string> names;
    std::set<Command> present;
    for (const CommandInfo& entry : commands()) {
        CHECK_MESSAGE(names.insert(entry.name).second, entry.name);
        CHECK_MESSAGE(present.insert(entry.command).second, entry.name);
        CHECK(std::string(entry.title) != "");
        CHECK(std::string(entry.help).back() == '.');
    }
    // `about` is the last of the enumeration.
    CHECK(present.size() == static_cast<std::size_t>(Command::about) + 1);
    for (int i = 0; i <= static_cast<int>(Command::about); ++i) {
        CHECK(info(static_cast<Command>(i)).command == static_cast<Command>(i));
    }
}

TEST_CASE("commands: no two share a key") {
    std::set<std::string> keysUsed;
    for (const CommandInfo& entry : commands()) {
        for (const Key& key : {entry.key, entry.otherKey}) {
            if (key.key != 0) CHECK_MESSAGE(keysUsed.insert(keyText(key)).second, keyText(key), " ", entry.name);
        }
    }
}

TEST_CASE("commands: each is in a menu, or is a tool, which has a button") {
    const std::set<std::string> menus{"File", "Edit", "View", "Scene", "Rig", "Show", "Help"};
    for (const CommandInfo& entry : commands()) {
        const bool tool = std::string(entry.name).starts_with("tool.");
        CHECK_MESSAGE((menus.contains(entry.menu) || tool), entry.name);
        if (tool) CHECK(entry.key.key != 0);
    }
}

TEST_CASE("commands: keys are written as they are printed on the keyboard") {
    CHECK(keyText(info(Command::redo).key) == "Ctrl+Shift+Z");
    CHECK(keyText(info(Command::safeLight).key) == "F12");
    CHECK(keyText(info(Command::take).key) == "Ctrl+Enter");
    CHECK(keyText(info(Command::shortcuts).key) == "?");
    CHECK(keyText(Key{}) == "");
    CHECK(bindingsText().find("region.look.focus") != std::string::npos);
}
