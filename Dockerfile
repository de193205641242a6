# Debian 12 with OpenFOAM, the compiled gas solver and sdph: the steps of `make setup`, which CI takes on a bare machine.
#   docker build -t sdph . && docker run --rm -v "$PWD:/work" sdph run bubbling_bed --out bed
FROM debian:bookworm
COPY . /sdph
RUN apt-get update -qq && apt-get install -y -qq --no-install-recommends make
RUN CI=true make -C /sdph setup
ENV PATH="/sdph/.venv/bin:$PATH"
WORKDIR /work
ENTRYPOINT ["sdph"]
