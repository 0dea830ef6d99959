// Fields in TOML files, by the tables that describe them.
#pragma once

#include <fmt/format.h>

#include <limits>
#include <vector>

#include "core/base/field.h"
#include "devices/files/toml_reader.h"

namespace limpid {

// Adds the keys of the fields that `owner` has.
template <class Table, class Owner>
void add_keys(const Table& fields, const Owner& owner, std::vector<const char*>& keys) {
  for (const Field<Owner>& field : fields) {
    if (field.of(owner)) keys.push_back(field.key);
  }
}

// Reads a field, if it is there. Errors: FileError for a value that is not allowed, and for a
// needed field that is missing.
template <class Owner>
void read_field(const TomlTable& t, const Field<Owner>& field, Owner& owner, bool needed) {
  const char* const key = field.key;
  if (t.find(key) == nullptr) {
    if (needed) t.refuse_missing(key);
    return;
  }
  with_member(field, owner, [&]<class T>(T& x) {
    if constexpr (std::is_same_v<T, double>) {
      x = *t.number(key, field);
    } else if constexpr (std::is_same_v<T, int>) {
      x = static_cast<int>(*t.count(key, static_cast<std::uint64_t>(field.minimum),
                                    static_cast<std::uint64_t>(field.maximum)));
    } else if constexpr (std::is_same_v<T, bool>) {
      x = *t.flag(key);
    } else if constexpr (std::is_same_v<T, std::string>) {
      x = *t.text(key);
    } else if constexpr (std::is_same_v<T, const Choice<Owner>>) {
      x.set(owner, static_cast<std::uint8_t>(*t.choice(key, field.words)));
    } else {
      x = *t.vector(key, field);
    }
  });
}

// Reads all fields that the owner has; of a part of another table its needed ones may be missing.
template <class Table, class Owner>
void read_fields(const TomlTable& t, const Table& fields, Owner& owner, bool whole = true) {
  for (const Field<Owner>& field : fields) {
    if (field.of(owner)) read_field(t, field, owner, field.needed && whole);
  }
}

// Inserts all fields but vectors, and those that are left open by default and still are. A number
// that is none is written, so that no reader takes the default instead.
template <class Table, class Owner>
void insert_fields(toml::table& table, const Table& fields, const Owner& owner) {
  for (const Field<Owner>& field : fields) {
    std::optional<FieldValue> value = value_of(field, owner);
    if (!value && field.kind == FieldInfo::Kind::number && value_of(field, Owner{})) {
      value = std::numeric_limits<double>::quiet_NaN();
    }
    if (!value) continue;
    std::visit(
        [&]<class T>(const T& x) {
          if constexpr (!std::is_same_v<T, Vec3>) table.insert_or_assign(field.key, x);
        },
        *value);
  }
}

}  // namespace limpid
