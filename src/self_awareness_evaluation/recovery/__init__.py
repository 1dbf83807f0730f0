"""The recovery beside the fast robot: are hanging nodes back in time, is a healthy one touched?"""
