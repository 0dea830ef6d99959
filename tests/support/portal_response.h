// A response of the desktop's portal for files.
#pragma once

#include <dbus/dbus.h>

#include <string>

#include "app/base/session_bus.h"

namespace limpid::test {

// Returns the signal that ends a portal's dialog: `how` 0 with this address of a file.
inline BusMessage portal_response(const std::string& handle, dbus_uint32_t how,
                                  const std::string& uri) {
  BusMessage signal(
      dbus_message_new_signal(handle.c_str(), "org.freedesktop.portal.Request", "Response"));
  DBusMessageIter at, results, entry, value, uris;
  dbus_message_iter_init_append(signal.get(), &at);
  dbus_message_iter_append_basic(&at, DBUS_TYPE_UINT32, &how);
  dbus_message_iter_open_container(&at, DBUS_TYPE_ARRAY, "{sv}", &results);
  if (!uri.empty()) {
    const char *const name = "uris", *const address = uri.c_str();
    dbus_message_iter_open_container(&results, DBUS_TYPE_DICT_ENTRY, nullptr, &entry);
    dbus_message_iter_append_basic(&entry, DBUS_TYPE_STRING, &name);
    dbus_message_iter_open_container(&entry, DBUS_TYPE_VARIANT, "as", &value);
    dbus_message_iter_open_container(&value, DBUS_TYPE_ARRAY, "s", &uris);
    dbus_message_iter_append_basic(&uris, DBUS_TYPE_STRING, &address);
    dbus_message_iter_close_container(&value, &uris);
    dbus_message_iter_close_container(&entry, &value);
    dbus_message_iter_close_container(&results, &entry);
  }
  dbus_message_iter_close_container(&at, &results);
  return signal;
}

}  // namespace limpid::test
