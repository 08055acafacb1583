# The static program alone: nothing else is in the container, and it does not run as root. Nothing is downloaded for it; `.ci/archive` makes
# the archives first.
#
#   .ci/archive x86_64-unknown-linux-musl
#   docker build -t gearloss .
#   docker run --rm --user "$(id -u):$(id -g)" -v "$PWD:/work" gearloss run study.yaml
ARG TARGETARCH

FROM scratch AS amd64
ADD target/archives/gearloss-*-x86_64-unknown-linux-musl.tar.gz /

FROM scratch AS arm64
ADD target/archives/gearloss-*-aarch64-unknown-linux-musl.tar.gz /

FROM ${TARGETARCH} AS unpacked

FROM scratch
COPY --from=unpacked /gearloss-*/gearloss /usr/bin/
COPY --from=unpacked /gearloss-*/LICENSE-* /usr/share/doc/gearloss/
COPY --from=unpacked /gearloss-*/examples/ /usr/share/gearloss/examples/
USER 65534:65534
WORKDIR /work
ENTRYPOINT ["/usr/bin/gearloss"]
CMD ["--help"]
