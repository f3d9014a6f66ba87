"""Double Wiebe functions that Shen et al. (2020) fitted to a marine engine, from low to high load."""

SHEN_2020 = (
    {"a_p": 3.415, "a_d": 23.8, "m_p": 1.148, "m_d": 1.006, "b": 0.6749},
    {"a_p": 3.769, "a_d": 23.72, "m_p": 1.292, "m_d": 0.9729, "b": 0.6481},
    {"a_p": 3.45, "a_d": 17.28, "m_p": 1.578, "m_d": 0.9035, "b": 0.6992},
    {"a_p": 3.319, "a_d": 12.71, "m_p": 2.2, "m_d": 0.7247, "b": 0.8023},
)
