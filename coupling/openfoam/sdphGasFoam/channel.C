/*---------------------------------------------------------------------------*\
sdphGasFoam: the gas phase of sdph. Copyright (C) 2025 the sdph authors.
This program is free software: you can redistribute it and/or modify it under
the terms of the GNU General Public License as published by the Free Software
Foundation, either version 3 of the License, or (at your option) any later
version. It comes WITHOUT ANY WARRANTY; see <http://www.gnu.org/licenses/>.
\*---------------------------------------------------------------------------*/
#include "channel.H"

#include <arpa/inet.h>
#include <chrono>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <netinet/tcp.h>
#include <poll.h>
#include <sstream>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <thread>
#include <unistd.h>

namespace
{

using Clock = std::chrono::steady_clock;

Clock::time_point after(double seconds)
{
    return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

std::string reason() { return std::strerror(errno); }

class SocketChannel : public Channel
{
    int socket_;

    int call(const std::string& address)
    {
        if (address.compare(0, 5, "unix:") == 0) return callUnix(address.substr(5));
        const size_t colon = address.rfind(':');
        return callTcp(address.substr(4, colon - 4), std::stoi(address.substr(colon + 1)));
    }

    int callUnix(const std::string& path)
    {
        sockaddr_un to{};
        to.sun_family = AF_UNIX;
        if (path.size() >= sizeof to.sun_path) throw wire::Error("the path of the socket is too long: " + path);
        std::strcpy(to.sun_path, path.c_str());
        return connected(AF_UNIX, reinterpret_cast<sockaddr*>(&to), sizeof to);
    }

    int callTcp(const std::string& host, int port)
    {
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_port = htons(port);
        if (inet_pton(AF_INET, host.c_str(), &to.sin_addr) != 1) throw wire::Error("not an address: " + host);
        const int s = connected(AF_INET, reinterpret_cast<sockaddr*>(&to), sizeof to);
        const int yes = 1;
        setsockopt(s, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
        return s;
    }

    int connected(int family, const sockaddr* to, socklen_t length)
    {
        const int s = ::socket(family, SOCK_STREAM | SOCK_CLOEXEC, 0);
        if (s < 0 || ::connect(s, to, length)) throw wire::Error("cannot reach the particles: " + reason());
        return s;
    }

    std::string read(size_t length)
    {
        std::string bytes(length, '\0');
        size_t place = 0;
        while (place < length)
        {
            pollfd waiting{socket_, POLLIN, 0};
            const int ready = ::poll(&waiting, 1, int(receiveTime*1000));
            if (ready == 0) throw wire::Error("the particles said nothing for a day");
            const ssize_t got = ready < 0 ? -1 : ::recv(socket_, &bytes[place], length - place, 0);
            if (got < 0 && errno == EINTR) continue;
            if (got <= 0) throw wire::Error("the particles closed the connection");
            place += got;
        }
        return bytes;
    }

public:

    explicit SocketChannel(const std::string& address) : socket_(call(address)) {}

    ~SocketChannel() override { ::close(socket_); }

    void send(const wire::Message& message) override
    {
        const std::string bytes = wire::encode(message);
        size_t place = 0;
        while (place < bytes.size())
        {
            const ssize_t put = ::send(socket_, bytes.data() + place, bytes.size() - place, MSG_NOSIGNAL);
            if (put < 0 && errno == EINTR) continue;
            if (put < 0) throw wire::Error("the particles closed the connection");
            place += put;
        }
    }

    wire::Message receive() override
    {
        const wire::Header header = wire::readHeader(read(wire::headerSize), limit);
        return wire::decode(header, read(header.length));
    }
};

class FileChannel : public Channel
{
    const std::string out_, in_;
    unsigned sent_ = 0, received_ = 0;

    void wait(const std::string& path)
    {
        const auto deadline = after(receiveTime);
        auto sleep = std::chrono::microseconds(50);
        struct stat found;
        while (::stat(path.c_str(), &found))
        {
            if (Clock::now() > deadline) throw wire::Error("the particles said nothing for a day");
            std::this_thread::sleep_for(sleep);
            sleep = std::min(std::chrono::microseconds(2000), sleep*6/5);
        }
        if (!S_ISREG(found.st_mode)) throw wire::Error(path + " is no plain file");
        if (uint64_t(found.st_size) > limit + wire::headerSize)
            throw wire::Error("a message is longer than this mesh allows");
    }

public:

    explicit FileChannel(const std::string& folder) : out_(folder + "/to_sdph/"), in_(folder + "/to_gas/") {}

    void send(const wire::Message& message) override
    {
        const std::string draft = out_ + "draft", path = out_ + std::to_string(sent_);
        const std::string bytes = wire::encode(message);
        errno = 0;
        std::ofstream file(draft, std::ios::binary);
        file.write(bytes.data(), bytes.size());
        file.close();
        if (!file || std::rename(draft.c_str(), path.c_str()))
            throw wire::Error("cannot write " + path + ": " + std::strerror(errno ? errno : EIO));
        ++sent_;
    }

    wire::Message receive() override
    {
        const std::string path = in_ + std::to_string(received_++);
        wait(path);
        std::ifstream file(path, std::ios::binary);
        std::stringstream content;
        content << file.rdbuf();
        const std::string bytes = content.str();
        ::unlink(path.c_str());
        return wire::decode(bytes, limit);
    }
};

// A process that ended but was not yet waited for by its parent (a zombie) is dead too.
bool isAlive(long pid)
{
    std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
    std::string line;
    if (!std::getline(file, line)) return false;
    const size_t name = line.rfind(')');
    return name != std::string::npos && name + 2 < line.size() && line[name + 2] != 'Z' && line[name + 2] != 'X';
}

} // namespace

std::unique_ptr<Channel> Channel::open(const std::string& address)
{
    if (address.compare(0, 5, "file:") == 0)
        return std::unique_ptr<Channel>(new FileChannel(address.substr(5)));
    if (address.compare(0, 5, "unix:") == 0 || address.compare(0, 4, "tcp:") == 0)
        return std::unique_ptr<Channel>(new SocketChannel(address));
    throw wire::Error("unknown address " + address + "; unix:<path>, tcp:<host>:<port> or file:<folder>");
}

void endWith(long pid)
{
    const pid_t parent = ::getppid();
    std::thread([pid, parent]
    {
        while (isAlive(pid) && ::getppid() == parent) std::this_thread::sleep_for(std::chrono::milliseconds(250));
        std::fprintf(stderr, "sdph (process %ld), or mpirun, has ended\n", pid);
        std::_Exit(1);
    }).detach();
}
