# A small image with the program `ipos`, for CI servers and for trying it: docs/guide/install.md.
#   docker build -t ipos .
#   docker run --rm -v "$PWD:/work" ipos ipos test .
FROM debian:12 AS build
# Git tells the commit for --version.
RUN apt-get update -qq && apt-get install -y -qq --no-install-recommends git
COPY . /src
RUN cd /src && ./dev static

FROM debian:12-slim
COPY --from=build /src/build/release/static/ipos /usr/local/bin/ipos
WORKDIR /work
CMD ["ipos", "--help"]
