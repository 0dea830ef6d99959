#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "devices/hid/device_list.h"
#include "devices/hid/hid_transport.h"
#include "tests/support/inverse_service.h"

namespace limpid {
namespace {

using test::InverseService;

std::string whole_name(const std::string& words) {
  const auto name = inverse_name(words);
  return name ? name->text() : "none";
}

TEST(InverseName, IsFilledUpWithWhatIsUsual) {
  EXPECT_EQ(whole_name("inverse3"), "inverse3@localhost:10001");
  EXPECT_EQ(whole_name("inverse3:049D"), "inverse3:049D@localhost:10001");
  EXPECT_EQ(whole_name("inverse3@desk"), "inverse3@desk:10001");
  EXPECT_EQ(whole_name("inverse3:049D@10.0.0.7:9000"), "inverse3:049D@10.0.0.7:9000");
  EXPECT_EQ(whole_name("inverse3.urdf"), "none");
  EXPECT_EQ(whole_name("046d:c62b"), "none");
  EXPECT_EQ(whole_name(""), "none");
}

TEST(InverseName, ThatCannotBeIsRefused) {
  for (const char* words : {"inverse3:", "inverse3:@desk", "inverse3@", "inverse3@:1",
                            "inverse3@desk:", "inverse3@desk:0", "inverse3@desk:65536",
                            "inverse3@desk:x", "inverse3@desk:1x"}) {
    EXPECT_THROW(inverse_name(words), HidError) << words;
  }
}

TEST(InverseDevices, AreThoseOfTheService) {
  InverseService service;
  const std::string place = service.address().text();
  auto found = list_inverse_devices({}, service.address());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].place.name, "Haply Inverse3 (" + place + ")");
  EXPECT_EQ(found[0].place.id, "inverse3:049D@" + place);
  EXPECT_EQ(found[0].missing, "");
  service.tell("devices 049D 04BA");
  service.tell("count");
  service.wait_for("messages 0");  // listing sends no message
  found = list_inverse_devices({}, service.address());
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[1].place.name, "Haply Inverse3 04BA (" + place + ")");
}

TEST(InverseDevices, ThatAreWantedAndNotThereAreListedWithWhatTheyLack) {
  InverseService service;
  const ServiceAddress nobody{"127.0.0.1", "1"};
  auto found = list_inverse_devices(InverseName{"04BA", service.address()}, nobody);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[1].place.id, "inverse3:04BA@" + service.address().text());
  EXPECT_NE(found[1].missing, "");
  service.tell("devices");
  service.tell("count");
  service.wait_for("messages 0");
  found = list_inverse_devices(InverseName{"", service.address()}, nobody);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].missing, "the service reports no Inverse3");
  EXPECT_TRUE(list_inverse_devices({}, nobody).empty());
  found = list_inverse_devices(InverseName{"", nobody}, nobody);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_THAT(found[0].missing, testing::StartsWith("no Haply Inverse Service at 127.0.0.1:1"));
}

// Other programs may use that port too.
TEST(InverseDevices, AreNoneWhereSomebodyListensAndSaysNothing) {
  const int listener = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(place);
  ASSERT_EQ(bind(listener, reinterpret_cast<const sockaddr*>(&place), size), 0);
  ASSERT_EQ(listen(listener, 4), 0);
  getsockname(listener, reinterpret_cast<sockaddr*>(&place), &size);
  const ServiceAddress address{"127.0.0.1", std::to_string(ntohs(place.sin_port))};
  EXPECT_TRUE(list_inverse_devices({}, address).empty());
  close(listener);
}

}  // namespace
}  // namespace limpid
