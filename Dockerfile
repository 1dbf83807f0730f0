# Monitor and programs on Debian 12, from this checkout:
#   docker build --tag self_awareness .
#   docker run --network host --volume /data:/data self_awareness \
#     roslaunch self_awareness learn.launch model:=/data/robot.model
FROM debian:bookworm
ENV SELF_AWARENESS_WORKSPACE=/opt/self_awareness
COPY . /usr/src/self_awareness
RUN bash -c 'source /usr/src/self_awareness/scripts/prepare.sh; install_packages without-tests; \
             build install' && \
    rm -rf /opt/self_awareness/build /opt/self_awareness/devel /var/cache/apt/* /var/lib/apt/lists/*
ENTRYPOINT ["bash", "-c", "source /opt/self_awareness/install/setup.bash && exec \"$@\"", "-"]
CMD ["rosrun", "self_awareness", "learn", "--help"]
