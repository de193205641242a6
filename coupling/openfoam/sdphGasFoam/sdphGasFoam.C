/*---------------------------------------------------------------------------*\
sdphGasFoam: the gas phase of sdph. Copyright (C) 2025 the sdph authors.
This program is free software: you can redistribute it and/or modify it under
the terms of the GNU General Public License as published by the Free Software
Foundation, either version 3 of the License, or (at your option) any later
version. It comes WITHOUT ANY WARRANTY; see <http://www.gnu.org/licenses/>.
\*---------------------------------------------------------------------------*/
// sdphGasFoam: the gas between the particles of sdph. It is started by sdph, calls it back at -address with the secret of
// the run, tells it the mesh and then does what it is told: start, advance, retreat, checkpoint, restore, close.

#include "channel.H"
#include "checkpoint.H"
#include "exchange.H"

#include <chrono>
#include <malloc.h>
#include <thread>

using namespace Foam;

namespace
{

// What the other ranks are told of a message: numbers and texts, and of arrays only that they are there
List<char> summary(const wire::Message& message)
{
    wire::Message small(message.kind);
    for (const auto& item : message.fields)
    {
        if (item.second.shape.empty() || item.second.type == wire::UTF8) small.fields.insert(item);
        else small.set(item.first, int64_t(0));
    }
    const std::string bytes = wire::encode(small);
    return List<char>(UList<char>(const_cast<char*>(bytes.data()), bytes.size()));
}

// Ranks other than the master wait here for the next message, asleep: MPI itself would spin, on the processors that the
// particles compute on meanwhile
void waitForMaster(const bool master)
{
    char bell = 0;
    if (master)
    {
        for (label rank = 1; rank < Pstream::nProcs(); ++rank)
            UOPstream::write(Pstream::commsTypes::scheduled, rank, &bell, 1);
        return;
    }
    const label request = Pstream::nRequests();
    UIPstream::read(Pstream::commsTypes::nonBlocking, Pstream::masterNo(), &bell, 1);
    while (!Pstream::finishedRequest(request)) std::this_thread::sleep_for(std::chrono::microseconds(100));
    Pstream::resetRequests(request);
}

// The next message, on every rank; its arrays on the master only
wire::Message nextMessage(Channel* channel)
{
    wire::Message message(channel ? channel->receive() : wire::Message(wire::CLOSE));
    if (!Pstream::parRun()) return message;
    waitForMaster(Pstream::master());
    List<char> bytes;
    if (channel) bytes = summary(message);
    compat::broadcast(bytes);
    if (channel) return message;
    const std::string encoded(bytes.cdata(), bytes.size());
    return wire::decode(encoded, wire::absoluteLimit);
}

void send(Channel* channel, const wire::Message& message)
{
    if (channel) channel->send(message);
}

void start(const wire::Message& message, GasSolver& solver, const Exchange& exchange)
{
    solver.sources.choose(message.text("sources"), solver.mesh);
    solver.ask(message.text("fields"));
    solver.start(exchange.alpha(message, message.has("alpha_g"), solver.alpha.primitiveField()));
}

// While it lives the clock stands in the middle of its step, so that what changes linearly in time at a boundary has its
// mean there: what comes in by a table is the integral of it (sdph/case/inlets.py)
class Halfway
{
    Time& time_;
    const scalar end_;

public:

    explicit Halfway(Time& time) : time_(time), end_(time.value())
    {
        time_.setTime(end_ - 0.5*time_.deltaTValue(), time_.timeIndex());
    }

    Halfway(const Halfway&) = delete;

    ~Halfway() { time_.setTime(end_, time_.timeIndex()); }
};

wire::Message advance(const wire::Message& message, GasSolver& solver, const Exchange& exchange, Time& time)
{
    const scalar dt = message.number("dt");
    if (!(dt > 0 && dt < GREAT))
    {
        std::ostringstream text;
        text << "dt is " << dt << " s; it must be above 0 and below " << GREAT << " s: choose another window";
        throw BadValue(text.str());
    }
    exchange.takeSources(message, solver.sources);
    const scalarField alphaEnd
    (
        exchange.alpha(message, solver.sources.has("alpha_g"), solver.alpha.primitiveField())
    );
    compat::setDeltaT(time, dt);
    ++time;
    Info<< "Time = " << time.value() << " s, dt = " << dt << " s" << endl;
    try
    {
        const Halfway halfway(time);
        solver.advance(alphaEnd);
    }
    catch (const NotFinite& why) { return Exchange::unfinished(why.what()); }
    const wire::Message state(exchange.state(solver));
    bool fine = state.kind == wire::STATE;
    reduce(fine, andOp<bool>());  // the master alone has looked
    if (fine && message.integer("write")) solver.write();
    return state;
}

void serve(Channel* channel, GasSolver& solver, const Exchange& exchange, Time& time)
{
    wire::Message before(wire::CHECKPOINT);
    while (true)
    {
        const wire::Message message = nextMessage(channel);
        switch (message.kind)
        {
            case wire::START:
                start(message, solver, exchange);
                send(channel, exchange.state(solver));
                break;
            case wire::ADVANCE:
                before = Checkpoint(solver).kept();
                send(channel, advance(message, solver, exchange, time));
                break;
            case wire::RETREAT:
                Checkpoint(solver).retreat(before, time);
                send(channel, exchange.state(solver));
                break;
            case wire::CHECKPOINT:
                Checkpoint(solver).write(message.text("folder"));
                send(channel, wire::Message(wire::DONE));
                break;
            case wire::RESTORE:
                Checkpoint(solver).read(message, time);
                solver.ask(message.text("fields"));
                send(channel, exchange.state(solver));
                break;
            case wire::CLOSE:
                return;
            default:
                throw wire::Error("sdph sent a message that only the gas sends");
        }
    }
}

// The first message: who knows the secret is let in
void greet(Channel* channel, const std::string& secret)
{
    wire::Message message(wire::HELLO);
    message.set("secret", secret);
    send(channel, message);
}

void run(const argList& args, Channel* channel, const std::string& turbulence)
{
    Time time(Time::controlDictName, args);
    fvMesh mesh(IOobject(fvMesh::defaultRegion, compat::timeName(time), time, IOobject::MUST_READ));
    const Exchange exchange(mesh);
    GasSolver solver(mesh, turbulence);
    send(channel, exchange.told(solver));
    if (channel) channel->limit = exchange.messageLimit();
    serve(channel, solver, exchange, time);
}

// Tell the particles, if they are there to be told, and the log
void report(Channel* channel, const std::string& text)
{
    std::cerr << "sdphGasFoam: " << text << std::endl;
    if (!channel) return;
    try
    {
        wire::Message message(wire::ERROR);
        message.set("text", text);
        channel->send(message);
    }
    catch (const wire::Error&) {}
}

} // namespace

int main(int argc, char* argv[])
{
    argList::addOption("address", "address", "where sdph listens: unix:<path>, tcp:<host>:<port> or file:<folder>");
    argList::addOption("turbulence", "library", "gasTurbulence, for a gas that is not laminar");
    argList::addOption("watch", "pid", "end when this process ends");
    // Fields come and go in every step: keep their memory rather than have the system give and clear it each time
    mallopt(M_MMAP_THRESHOLD, 1 << 30);
    mallopt(M_TRIM_THRESHOLD, 1 << 30);
    const argList args(argc, argv);
    if (!args.checkRootCase()) return 1;
    if (args.options().found("watch")) endWith(std::stol(args.options()["watch"]));
    const std::string turbulence = args.options().found("turbulence") ? args.options()["turbulence"] : "";
    std::unique_ptr<Channel> channel;
    std::string text;
    compat::throwErrors();
    try
    {
        if (Pstream::master()) channel = Channel::open(args.options()["address"]);
        greet(channel.get(), getEnv("SDPH_SECRET"));
        run(args, channel.get(), turbulence);
        return 0;
    }
    catch (const Foam::error& error) { text = error.message(); }
    catch (const std::exception& error) { text = error.what(); }
    report(channel.get(), text);
    // The other ranks wait for this one inside MPI: end them too
    if (Pstream::parRun()) Pstream::exit(1);
    std::exit(1);  // a return destroys `args`, which in openfoam.com v1912 ends the program with 0
}
