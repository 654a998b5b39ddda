// SPDX-License-Identifier: MIT
// Clients that ask for much and read nothing.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <httplib.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <fstream>
#include <vector>

#include "running_session.h"

namespace live {
namespace {

/// Bytes of memory that this process has.
std::size_t memory() {
  std::ifstream file("/proc/self/statm");
  std::size_t size = 0, resident = 0;
  file >> size >> resident;
  return resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

/// A connection with requests whose answers nobody reads.
int stalled_connection(unsigned port, std::size_t requests) {
  const int connection = socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const int little = 4096;
  setsockopt(connection, SOL_SOCKET, SO_RCVBUF, &little, sizeof(little));
  (void)connect(connection, reinterpret_cast<const sockaddr*>(&address), sizeof(address));
  std::string text;
  for (std::size_t i = 0; i < requests; ++i) {
    text += "GET /picture.jpg HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) + "\r\n\r\n";
  }
  // As much as goes.
  (void)send(connection, text.data(), text.size(), MSG_NOSIGNAL);
  return connection;
}

TEST(StalledClients, TakeNoMemoryAndAreLeft) {
  Options options = RunningSession::small("stalled");
  options.width = options.height = 512;
  options.samples_per_pixel = 0.5;
  RunningSession running(options);
  running.start();
  const unsigned port = running.server().port();
  httplib::Client http("127.0.0.1", static_cast<int>(port));
  http.set_connection_timeout(60);
  http.set_read_timeout(60);
  while (!running.session().board().newest() || !running.session().board().newest()->finished) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ASSERT_EQ(http.Get("/picture.jpg")->status, 200);
  const std::size_t before = memory();
  std::vector<int> connections;
  for (int i = 0; i < 100; ++i) connections.push_back(stalled_connection(port, 1000));

  // Revisions are made all the same, and those who read get the newest.
  const std::uint64_t first = running.session().board().newest()->number;
  for (int i = 0; i < 10; ++i) {
    const std::uint64_t number = running.session().board().newest()->number;
    running.session().look({.stops = 0.1 * i, .quality = 90});
    ASSERT_GT(running.session().board().newer_than(number, std::chrono::seconds(60))->number,
              number);
  }
  const auto answer = http.Get("/picture.jpg");
  ASSERT_TRUE(answer) << httplib::to_string(answer.error());
  EXPECT_EQ(answer->get_header_value("X-Revision"), std::to_string(first + 10));
  // 100,000 pictures of 50 KB would be 5 GB, one for each connection 5 MB.
  EXPECT_LT(memory(), before + (std::size_t{64} << 20));
  for (const int connection : connections) close(connection);
}

}  // namespace
}  // namespace live
