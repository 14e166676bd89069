// As much of SQLite as the wave database needs: a database in memory, statements, and a checksum as an SQL function.
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/result.h"

namespace ilf::projects {

/// One statement; columns and parameters count from 0. After the first failure nothing happens any more.
class Statement {
public:
    Statement(sqlite3* database, const std::string& sql);

    Statement& bind(int at, double value);
    Statement& bind(int at, std::int64_t value);
    Statement& bind(int at, std::string_view text);
    Statement& bindBytes(int at, std::string_view bytes);
    Statement& bindNothing(int at);
    /// True while there is a row.
    bool step();
    /// To the end, then ready for the next values.
    bool run();
    bool failed() const;

    /// None where the column is no finite number.
    std::optional<double> number(int at) const;
    std::int64_t whole(int at) const;
    std::string text(int at) const;
    std::string bytes(int at) const;
    bool nothing(int at) const;

private:
    struct Finalize {
        void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
    };
    std::unique_ptr<sqlite3_stmt, Finalize> statement_;
    int status_ = SQLITE_OK;
};

/// A database in memory: nothing is written where SQLite wants to, so no journal can be left lying.
class MemoryDatabase {
public:
    /// Empty, to be filled.
    MemoryDatabase();
    /// Reads `bytes` in place; they must outlive it.
    explicit MemoryDatabase(std::string& bytes);

    bool execute(const std::string& sql);
    Statement statement(const std::string& sql) { return Statement(database_.get(), sql); }
    /// The content as a file.
    std::string file();
    /// What SQLite says was wrong last.
    std::string complaint() const;

private:
    struct Close {
        void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
    };
    std::unique_ptr<sqlite3, Close> database_;
};

}  // namespace ilf::projects
