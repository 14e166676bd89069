#include "projects/wave_sqlite.h"

#include <bit>
#include <cmath>
#include <cstring>

#include "projects/wave_checksum.h"

namespace ilf::projects {
namespace {

std::string_view bytesOf(sqlite3_value* value) {
    const void* data = sqlite3_value_blob(value);
    return {static_cast<const char*>(data), data == nullptr ? 0 : static_cast<std::size_t>(sqlite3_value_bytes(value))};
}

void addNumber(Sha256& sum, char kind, std::uint64_t number) {
    char text[9] = {kind};
    for (int i = 0; i < 8; ++i)
        text[i + 1] = static_cast<char>(number >> (8 * i));
    sum.add({text, sizeof text});
}

/// SQL's sealed(a, b, ...): SHA-256 over each value's kind (I, R, T, B, N), then the integer or IEEE 754 number in
/// little endian, or the length in bytes in the same way followed by the bytes.
void sealed(sqlite3_context* context, int count, sqlite3_value** values) {
    Sha256 sum;
    for (int i = 0; i < count; ++i) {
        sqlite3_value* value = values[i];
        switch (sqlite3_value_type(value)) {
        case SQLITE_INTEGER:
            addNumber(sum, 'I', static_cast<std::uint64_t>(sqlite3_value_int64(value)));
            break;
        case SQLITE_FLOAT:
            addNumber(sum, 'R', std::bit_cast<std::uint64_t>(sqlite3_value_double(value)));
            break;
        case SQLITE_NULL:
            addNumber(sum, 'N', 0);
            break;
        default: {
            const bool text = sqlite3_value_type(value) == SQLITE_TEXT;
            const std::string_view bytes = bytesOf(value);
            addNumber(sum, text ? 'T' : 'B', bytes.size());
            sum.add(bytes);
        }
        }
    }
    const auto digest = sum.value();
    sqlite3_result_blob(context, digest.data(), static_cast<int>(digest.size()), SQLITE_TRANSIENT);
}

sqlite3* opened() {
    sqlite3* database = nullptr;
    if (sqlite3_open_v2(":memory:", &database, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX,
                        nullptr) != SQLITE_OK) {
        return database;
    }
    // What a file's own schema says is not trusted with anything.
    sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_create_function_v2(database, "sealed", -1, SQLITE_UTF8 | SQLITE_DETERMINISTIC | SQLITE_DIRECTONLY, nullptr,
                               sealed, nullptr, nullptr, nullptr);
    return database;
}

}  // namespace

Statement::Statement(sqlite3* database, const std::string& sql) {
    sqlite3_stmt* statement = nullptr;
    status_ = sqlite3_prepare_v2(database, sql.c_str(), -1, &statement, nullptr);
    statement_.reset(statement);
}

Statement& Statement::bind(int at, double value) {
    if (!failed()) status_ = sqlite3_bind_double(statement_.get(), at + 1, value);
    return *this;
}
Statement& Statement::bind(int at, std::int64_t value) {
    if (!failed()) status_ = sqlite3_bind_int64(statement_.get(), at + 1, value);
    return *this;
}
Statement& Statement::bind(int at, std::string_view text) {
    if (!failed()) {
        status_ =
            sqlite3_bind_text(statement_.get(), at + 1, text.data(), static_cast<int>(text.size()), SQLITE_TRANSIENT);
    }
    return *this;
}
Statement& Statement::bindBytes(int at, std::string_view bytes) {
    if (!failed()) {
        status_ =
            sqlite3_bind_blob(statement_.get(), at + 1, bytes.data(), static_cast<int>(bytes.size()), SQLITE_TRANSIENT);
    }
    return *this;
}
Statement& Statement::bindNothing(int at) {
    if (!failed()) status_ = sqlite3_bind_null(statement_.get(), at + 1);
    return *this;
}

bool Statement::failed() const { return status_ != SQLITE_OK && status_ != SQLITE_ROW && status_ != SQLITE_DONE; }

bool Statement::step() {
    if (failed()) return false;
    status_ = sqlite3_step(statement_.get());
    return status_ == SQLITE_ROW;
}

bool Statement::run() {
    while (step()) {
    }
    if (failed()) return false;
    sqlite3_reset(statement_.get());
    return true;
}

std::optional<double> Statement::number(int at) const {
    const int type = sqlite3_column_type(statement_.get(), at);
    if (type != SQLITE_FLOAT && type != SQLITE_INTEGER) return std::nullopt;
    const double value = sqlite3_column_double(statement_.get(), at);
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
}
std::int64_t Statement::whole(int at) const { return sqlite3_column_int64(statement_.get(), at); }
bool Statement::nothing(int at) const { return sqlite3_column_type(statement_.get(), at) == SQLITE_NULL; }

std::string Statement::bytes(int at) const {
    const void* data = sqlite3_column_blob(statement_.get(), at);
    if (data == nullptr) return {};
    return {static_cast<const char*>(data), static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), at))};
}
std::string Statement::text(int at) const {
    const unsigned char* data = sqlite3_column_text(statement_.get(), at);
    if (data == nullptr) return {};
    return {reinterpret_cast<const char*>(data), static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), at))};
}

MemoryDatabase::MemoryDatabase() : database_(opened()) {}

MemoryDatabase::MemoryDatabase(std::string& bytes) : database_(opened()) {
    const auto size = static_cast<sqlite3_int64>(bytes.size());
    sqlite3_deserialize(database_.get(), "main", reinterpret_cast<unsigned char*>(bytes.data()), size, size,
                        SQLITE_DESERIALIZE_READONLY);
    execute("PRAGMA cell_size_check=ON; PRAGMA mmap_size=0;");
}

bool MemoryDatabase::execute(const std::string& sql) {
    return sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK;
}

std::string MemoryDatabase::file() {
    sqlite3_int64 size = 0;
    const std::unique_ptr<unsigned char, decltype(&sqlite3_free)> bytes(
        sqlite3_serialize(database_.get(), "main", &size, 0), &sqlite3_free);
    if (!bytes) return {};
    return {reinterpret_cast<const char*>(bytes.get()), static_cast<std::size_t>(size)};
}

std::string MemoryDatabase::complaint() const { return sqlite3_errmsg(database_.get()); }

}  // namespace ilf::projects
